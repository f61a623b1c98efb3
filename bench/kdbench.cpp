// kdbench: measures speed, memory and error, and proves exactness.
#include "commands.h"
#include "common/console.h"

int main(int argc, char** argv) {
  using namespace kd::bench;
  CLI::App app("Measures trees: what they take to build and to hold, and how fast rays pass through them.", kKdbench);
  app.require_subcommand(1);
  const Command commands[] = {trace_command(app),    frame_command(app),  floor_command(app),  paper_command(app),
                              sweep_command(app),    pareto_command(app), stress_command(app), build_command(app),
                              surface_command(app),  forest_command(app), city_command(app),   scale_command(app),
                              instances_command(app)};
  return kd::tools::run_tool(app, argc, argv, [&] {
    for (const Command& command : commands) {
      if (command.subcommand->parsed()) return command.run();
    }
    return 1;
  });
}
