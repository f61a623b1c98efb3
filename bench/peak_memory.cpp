#include "peak_memory.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <new>
#include <sstream>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "kdbuild/build_source.h"
#include "sys/parallel.h"

namespace kd::bench {

namespace {

/// A line of /proc/self/status, "VmHWM:    1234 kB", in bytes; 0 if there is none.
uint64_t status_bytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(name + ":")) return std::stoull(line.substr(name.size() + 1)) * 1024;
  }
  return 0;
}

/// What the child has to say, as lines: a status (0: done), then either the two figures or where and what went wrong.
/// Throws nothing: the child must not unwind what is its parent's.
std::string measure(const std::string& input, const std::string& output, const tools::CompileSettings& settings,
                    unsigned threads) noexcept {
  const uint64_t before = status_bytes("VmRSS");
  try {
    const ThreadLimit limit(threads);
    const auto report = tools::build_object(input, output, settings);
    if (report) return fmt::format("0\n{} {}\n", before, status_bytes("VmHWM"));
    return fmt::format("{}\n{}\n{}\n", static_cast<int>(report.error().error_class), report.error().where,
                       report.error().what);
  } catch (const std::bad_alloc&) {
    return fmt::format("{}\n{}\nout of memory\n", static_cast<int>(ErrorClass::resource), input);
  }
}

std::string read_all(int file) {
  std::string text;
  std::array<char, 4096> buffer;
  for (;;) {
    const ssize_t got = read(file, buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return text;
    text.append(buffer.data(), static_cast<size_t>(got));
  }
}

Result<PeakMemory> parse(const std::string& text, const std::string& input) {
  std::istringstream lines(text);
  int status = -1;
  PeakMemory memory;
  std::string where, what;
  if (!(lines >> status)) {
    return Error{ErrorClass::resource, input,
                 "the process that compiled it died: out of memory, or a fault of our own"};
  }
  if (status == 0 && lines >> memory.before >> memory.peak && memory.before > 0 && memory.peak > memory.before) {
    return memory;
  }
  if (status == 0) return Error{ErrorClass::resource, "/proc/self/status", "does not tell VmRSS and VmHWM"};
  lines.ignore();
  std::getline(lines, where);
  std::getline(lines, what);
  return Error{static_cast<ErrorClass>(status), where, what};
}

}  // namespace

Result<PeakMemory> compile_in_child(const std::string& input, const std::string& output,
                                    const tools::CompileSettings& settings, unsigned threads) {
  const Error no_child{ErrorClass::resource, input, "cannot start a process to compile it in"};
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return no_child;
  std::fflush(nullptr);  // or the child has what waits in buffers too
  const pid_t child = fork();
  if (child == 0) {
    const std::string said = measure(input, output, settings, threads);
    const bool told = write(ends[1], said.data(), said.size()) == static_cast<ssize_t>(said.size());
    _exit(told ? 0 : 1);
  }
  close(ends[1]);
  const std::string said = child > 0 ? read_all(ends[0]) : "";
  close(ends[0]);
  if (child < 0) return no_child;
  while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
  return parse(said, input);
}

}  // namespace kd::bench
