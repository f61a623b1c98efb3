#include "common/console.h"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <new>
#include <set>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "sys/atomic_file.h"
#include "sys/timer.h"

namespace kd::tools {

namespace {

std::atomic<bool> interrupt_seen = false;

/// One line, whatever a library put into a message.
std::string one_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  for (char& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

bool processor_suffices() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
#else
  return true;
#endif
}

/// "5 s", "2 min 05 s", "3 h 07 min".
std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(seconds + 0.5);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

}  // namespace

std::string version_text() { return "kdtrace " KD_VERSION; }

std::string exit_status_text() {
  return "Exit status: 0 done; 2 usage; 3 input missing or unreadable; 4 bad mesh; 5 bad .nkd; 6 bad scene;\n"
         "7 output not writable; 8 device not there or failed; 9 out of memory or size; 10 interrupted;\n11 differs "
         "from its reference; 1 a fault of "
         "our own.";
}

int fail(std::string_view tool, const Error& error) {
  fmt::print(stderr, "{}: error: {}\n", tool, one_line(error.line()));
  return static_cast<int>(error.error_class);
}

void warn(std::string_view tool, const std::string& text) {
  fmt::print(stderr, "{}: warning: {}\n", tool, one_line(text));
}

CLI::Validator whole_number(int64_t lo, int64_t hi) {
  const auto check = [lo, hi](std::string& text) -> std::string {
    int64_t value = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool fits = parsed.ec == std::errc{} && parsed.ptr == text.data() + text.size() && value >= lo && value <= hi;
    return fits ? "" : fmt::format("'{}' is not a whole number from {} to {}", text, lo, hi);
  };
  return CLI::Validator(check, fmt::format("[{} - {}]", lo, hi));
}

CLI::Validator number(double lo, double hi) {
  const auto check = [lo, hi](std::string& text) -> std::string {
    double value = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool fits = parsed.ec == std::errc{} && parsed.ptr == text.data() + text.size() && value >= lo && value <= hi;
    return fits ? "" : fmt::format("'{}' is not a number from {} to {}", text, lo, hi);
  };
  return CLI::Validator(check, fmt::format("[{} - {}]", lo, hi));
}

CLI::Validator file_name() {
  const auto check = [](std::string& text) -> std::string {
    if (text.empty()) return "needs a file name";
    return text == "-" ? "needs a file name, and cannot be stdout: ./- is a file of that name" : "";
  };
  return CLI::Validator(check, "");
}

namespace {

/// A set of files under any of their names.
class Files {
 public:
  bool contains(const std::string& path) const { return known_.contains(identity(path)); }
  void add(const std::string& path) { known_.insert(identity(path)); }

 private:
  /// Which file it is, or where the name of one that is not there yet leads: finding that out takes several times as
  /// long, and a scene may list files by the thousand.
  static std::string identity(const std::string& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) == 0) return fmt::format("{}:{}", status.st_dev, status.st_ino);
    std::error_code none;
    // Of a name without a folder, weakly_canonical would make no whole path.
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path, none), none).string();
  }

  std::set<std::string> known_;
};

bool is_file(const std::string& output) { return !output.empty() && output != "-"; }

}  // namespace

Result<void> check_distinct(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  Files read, written;
  for (const std::string& input : inputs) read.add(input);
  for (const std::string& output : outputs) {
    if (!is_file(output)) continue;
    if (read.contains(output))
      return Error{ErrorClass::usage, output, "the output is also an input: name another file"};
    if (written.contains(output))
      return Error{ErrorClass::usage, output, "two outputs have this name: name another file"};
    written.add(output);
  }
  return {};
}

Result<void> check_outputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  if (auto distinct = check_distinct(outputs, inputs); !distinct) return distinct;
  for (const std::string& output : outputs) {
    if (!is_file(output)) continue;
    if (auto writable = check_writable(output); !writable) return writable;
  }
  return {};
}

namespace {

/// What CLI11 found wrong, and where to read on. Its own text for a word that is no command names no word.
Error usage_error(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  const auto parsed = app.get_subcommands();
  const std::string help = app.get_name() + (parsed.empty() ? "" : " " + parsed.front()->get_name()) + " --help";
  const auto commands = app.get_subcommands([](const CLI::App*) { return true; });
  if (!commands.empty() && parsed.empty() && argc > 1 && argv[1][0] != '-') {
    std::vector<std::string> names;
    for (const CLI::App* command : commands) names.push_back(command->get_name());
    return {ErrorClass::usage, "",
            fmt::format("'{}' is not a command: use {} (see {})", argv[1], fmt::join(names, ", "), help)};
  }
  return {ErrorClass::usage, "", fmt::format("{} (see {})", one_line(error.what()), help)};
}

/// What was printed may still be in a buffer, and the disk full.
int flushed(std::string_view tool, int status) {
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return status;
  const int failed = fail(tool, {ErrorClass::output, "stdout", "cannot write all of the output"});
  return status != 0 ? status : failed;
}

}  // namespace

int run_tool(CLI::App& app, int argc, char** argv, const std::function<int()>& run) {
  const std::string tool = app.get_name();
  if (!processor_suffices()) {
    return fail(tool,
                {ErrorClass::device, "", "this processor lacks AVX2, FMA or BMI2 (x86-64-v3), which this build uses"});
  }
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit is then an error like any other
  app.footer(exit_status_text());
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    command->footer(exit_status_text());
  app.set_version_flag("--version", version_text());
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {  // --help, --version
    return app.exit(request);
  } catch (const CLI::ParseError& e) {
    return fail(tool, usage_error(app, e, argc, argv));
  }
  try {
    return flushed(tool, run());
  } catch (const std::bad_alloc&) {
    return fail(tool, {ErrorClass::resource, "", "out of memory"});
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}: internal error: {}\n", tool, one_line(e.what()));
    return 1;
  }
}

Progress progress_bar(std::string label, bool quiet) {
  const bool shown = !quiet && isatty(STDERR_FILENO);
  return [label = std::move(label), shown, timer = Timer()](double share) {
    if (shown) {
      // What is left is known once a second and a hundredth have gone by.
      const double past = timer.seconds();
      const std::string left =
          past > 1 && share > 0.01 ? fmt::format("  {} left", duration_text(past / share - past)) : "";
      fmt::print(stderr, "\r{}  {:3.0f} %{}\033[K{}", label, 100 * share, left, share >= 1 ? "\r\033[K" : "");
      std::fflush(stderr);
    }
    return !interrupt_seen.load();
  };
}

void catch_interrupts() {
  const auto note = [](int) { interrupt_seen = true; };
  struct sigaction action {};
  action.sa_handler = note;  // and no SA_RESTART: a call that waits returns
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() { return interrupt_seen; }

}  // namespace kd::tools
