// kdrender: renders a scene file to OpenEXR, and pictures to look at; one frame or many.
#include "common/console.h"
#include "kdrender/options.h"
#include "kdrender/render_command.h"

int main(int argc, char** argv) {
  using namespace kd;
  using namespace kd::tools;
  CLI::App app("Renders a scene of .nkd objects to OpenEXR, on CUDA or on the CPU.", kKdrender);
  RenderOptions options;
  add_options(app, options);
  return run_tool(app, argc, argv, [&] {
    const auto rendered = render_command(options);
    return rendered ? 0 : fail(kKdrender, rendered.error());
  });
}
