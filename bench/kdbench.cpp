// kdbench: measures speed, memory and error.
#include "commands.h"
#include "common/console.h"

int main(int argc, char** argv) {
  using namespace kd::bench;
  CLI::App app("Measures traversal: rays a second, bytes, hits, on the CPU or on CUDA.", kKdbench);
  app.require_subcommand(1);
  const Command commands[] = {trace_command(app)};
  return kd::tools::run_tool(app, argc, argv, [&] {
    for (const Command& command : commands) {
      if (command.subcommand->parsed()) return command.run();
    }
    return 1;
  });
}
