// kdbuild: compiles meshes to objects, and tells what is in one and whether it is sound.
#include "common/console.h"
#include "kdbuild/commands.h"

int main(int argc, char** argv) {
  using namespace kd::tools;
  CLI::App app("Compiles static meshes to .nkd objects: normalised, in fixed point, under an SAH kd-tree.", kKdbuild);
  app.require_subcommand(1);
  const Command commands[] = {build_command(app), info_command(app), validate_command(app)};
  return run_tool(app, argc, argv, [&] {
    for (const Command& command : commands) {
      if (command.subcommand->parsed()) return command.run();
    }
    return 1;
  });
}
