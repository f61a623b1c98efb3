#include "common/console.h"

#include <atomic>
#include <csignal>
#include <cstdio>
#include <new>

#include <fmt/format.h>
#include <unistd.h>

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

}  // namespace

std::string version_text() { return "kdtrace " KD_VERSION; }

std::string exit_status_text() {
  return "Exit status: 0 done; 2 usage; 3 input missing or unreadable; 4 bad mesh; 5 bad .nkd; 6 bad scene;\n"
         "7 output not writable; 8 device not there or failed; 9 out of memory or size; 10 interrupted; 1 a fault of "
         "our own.";
}

int fail(std::string_view tool, const Error& error) {
  fmt::print(stderr, "{}: error: {}\n", tool, one_line(error.line()));
  return static_cast<int>(error.error_class);
}

int run_tool(CLI::App& app, int argc, char** argv, const std::function<int()>& run) {
  const std::string tool = app.get_name();
  if (!processor_suffices()) {
    return fail(tool,
                {ErrorClass::device, "", "this processor lacks AVX2, FMA or BMI2 (x86-64-v3), which this build uses"});
  }
  app.footer(exit_status_text());
  app.set_version_flag("--version", version_text());
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {  // --help, --version
    return app.exit(request);
  } catch (const CLI::ParseError& e) {
    return fail(tool, {ErrorClass::usage, "", one_line(e.what()) + fmt::format(" (see {} --help)", tool)});
  }
  try {
    return run();
  } catch (const std::bad_alloc&) {
    return fail(tool, {ErrorClass::resource, "", "out of memory"});
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}: internal error: {}\n", tool, one_line(e.what()));
    return 1;
  }
}

Progress progress_bar(std::string label, bool quiet) {
  const bool shown = !quiet && isatty(STDERR_FILENO);
  return [label = std::move(label), shown](double share) {
    if (shown) {
      fmt::print(stderr, "\r{}  {:3.0f} %{}", label, 100 * share, share >= 1 ? "\r\033[K" : "");
      std::fflush(stderr);
    }
    return !interrupt_seen.load();
  };
}

void catch_interrupts() {
  const auto note = [](int) { interrupt_seen = true; };
  std::signal(SIGINT, note);
  std::signal(SIGTERM, note);
}

bool interrupted() { return interrupt_seen; }

}  // namespace kd::tools
