// Black-box tests: the built tools run in a temporary folder, and what they print, return and leave there.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "support/workshop.h"
#include "sys/error.h"

namespace kd::test {

using Arguments = std::vector<std::string>;

inline Arguments joined(Arguments first, const Arguments& more) {
  first.insert(first.end(), more.begin(), more.end());
  return first;
}

struct ToolRun {
  int status = 0;  // the exit status, or minus the signal that ended it
  std::string out, err;
};

/// What a run is subjected to.
struct Conditions {
  std::string stdout_file;                    // instead of being captured
  std::optional<unsigned long> largest_file;  // bytes (RLIMIT_FSIZE)
  int signal = 0;                             // sent `signal_after` the start, if it still runs then
  std::chrono::milliseconds signal_after{0};
  std::chrono::seconds patience{60};  // then SIGKILL
};

/// A folder to work in, which disappears with its owner, and the tools as a shell there would run them.
class Terminal {
 public:
  ToolRun run(const std::string& tool, const Arguments& arguments, const Conditions& conditions = {}) const;

  /// Runs, and checks that it exits with 0 and prints nothing to stderr.
  ToolRun succeeds(const std::string& tool, const Arguments& arguments) const;

  /// Runs, and checks that it fails as every tool should: this class, one line "tool: error: ..." on stderr that holds
  /// all `fragments`, and the folder as it was before.
  ToolRun fails(const std::string& tool, const Arguments& arguments, ErrorClass error_class,
                const std::vector<std::string>& fragments, const Conditions& conditions = {}) const;

  /// The JSON that a run which must succeed prints.
  nlohmann::json report(const std::string& tool, const Arguments& arguments) const;

  std::string path(const std::string& name) const { return (workshop_.folder() / name).string(); }
  bool exists(const std::string& name) const;
  void write(const std::string& name, const std::string& bytes) const;
  std::string read(const std::string& name) const;
  std::map<std::string, std::string> snapshot() const;  // name -> bytes, of everything in the folder

  /// Compiles a mesh of data/ to compiled/STEM.nkd, in this process.
  void compile_data(const std::string& name) { workshop_.compile(source_root() / "data" / name); }
  /// Copies spheres.json here and compiles the objects that it places.
  void set_up_spheres() { workshop_.data_scene("spheres.json"); }

 private:
  Workshop workshop_;
};

/// A file of data/.
std::string data_file(const std::string& name);

/// What a program of the system prints; nothing if it is not installed, with a message.
std::optional<std::string> system_output(const std::string& program, const std::string& arguments);

}  // namespace kd::test
