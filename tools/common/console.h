// What the command lines share: how they start, fail, show progress and stop.
#pragma once

#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

#include "sys/error.h"
#include "sys/progress.h"

namespace kd::tools {

std::string version_text();

/// The exit statuses, for --help.
std::string exit_status_text();

/// Prints "tool: error: ..." as one line to stderr and returns the status to exit with.
int fail(std::string_view tool, const Error& error);

/// Runs a command line: checks the processor, parses, calls `run`, and turns what CLI11 or anything else throws into a
/// line and a status.
int run_tool(CLI::App& app, int argc, char** argv, const std::function<int()>& run);

/// A progress bar on stderr, "label  42 %", if that is a terminal and not `quiet`; nothing otherwise. Either way it
/// cancels once the user has pressed Ctrl-C.
Progress progress_bar(std::string label, bool quiet);

/// From here on Ctrl-C and SIGTERM cancel through `progress_bar` and `interrupted` instead of killing the process.
void catch_interrupts();
bool interrupted();

}  // namespace kd::tools
