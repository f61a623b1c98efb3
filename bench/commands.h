// The commands of kdbench.
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

namespace kd::bench {

constexpr const char* kKdbench = "kdbench";

struct Command {
  CLI::App* subcommand = nullptr;
  std::function<int()> run;
};

Command build_command(CLI::App& app);
Command city_command(CLI::App& app);
Command floor_command(CLI::App& app);
Command forest_command(CLI::App& app);
Command frame_command(CLI::App& app);
Command instances_command(CLI::App& app);
Command paper_command(CLI::App& app);
Command pareto_command(CLI::App& app);
Command scale_command(CLI::App& app);
Command stress_command(CLI::App& app);
Command surface_command(CLI::App& app);
Command sweep_command(CLI::App& app);
Command trace_command(CLI::App& app);

}  // namespace kd::bench
