// What the command lines share: how they start, fail, show progress and stop.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "sys/progress.h"
#include "sys/result.h"

namespace kd::tools {

std::string version_text();

/// The exit statuses, for --help.
std::string exit_status_text();

/// Prints "tool: error: ..." as one line to stderr and returns the status to exit with.
int fail(std::string_view tool, const Error& error);
/// Prints "tool: warning: ..." as one line to stderr.
void warn(std::string_view tool, const std::string& text);

/// Checks of an option's value that say what is wanted: a number in [lo, hi] (NaN is not), the name of a file, which is
/// not empty, nor "-" for stdout.
CLI::Validator whole_number(int64_t lo, int64_t hi);
CLI::Validator number(double lo, double hi);
CLI::Validator file_name();

/// That no output is an input or another output; empty names and "-" are passed over.
Result<void> check_distinct(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);
/// The same, and that each output can be written.
Result<void> check_outputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

/// Runs a command line: checks the processor, parses, calls `run`, and turns what CLI11 or anything else throws into a
/// line and a status.
int run_tool(CLI::App& app, int argc, char** argv, const std::function<int()>& run);

/// A progress bar on stderr, "label  42 %  5 s left", if that is a terminal and not `quiet`; nothing otherwise. Either
/// way it cancels once the user has pressed Ctrl-C.
Progress progress_bar(std::string label, bool quiet);

/// From here on Ctrl-C and SIGTERM cancel through `progress_bar` and `interrupted` instead of killing the process.
void catch_interrupts();
bool interrupted();

}  // namespace kd::tools
