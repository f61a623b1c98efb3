// The commands of kdbuild. Each adds its subcommand to the app and returns what runs it.
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

namespace kd::tools {

constexpr const char* kKdbuild = "kdbuild";

/// A subcommand, and what to call if it was given; the call returns the exit status.
struct Command {
  CLI::App* subcommand = nullptr;
  std::function<int()> run;
};

Command build_command(CLI::App& app);
Command info_command(CLI::App& app);
Command validate_command(CLI::App& app);

}  // namespace kd::tools
