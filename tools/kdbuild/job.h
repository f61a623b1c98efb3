// What goes in and what comes out: a command line's inputs, and the files that are made of each.
#pragma once

#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "sys/result.h"

namespace kd::tools {

struct Job {
  std::string input;
  std::string object;  // the .nkd to write if the source is one mesh

  /// `object` without .nkd. What is no single mesh becomes BASE.json, a scene, and BASE.NAME.nkd for each object in it.
  std::string base() const;
  std::string scene() const { return base() + ".json"; }
  std::string part(const std::string& name) const { return base() + "." + name + ".nkd"; }
  /// What BASE is without its folder.
  std::string name() const;
};

/// The files that a run reads and writes.
struct Neighbours {
  std::vector<std::string> inputs, outputs;
};

/// Who writes what: no source may write over an input, over what another one, or the run itself, writes, or over a
/// scene that is somebody's work. Shared by the sources that are built at once.
class Claims {
 public:
  /// `force`: scenes may be replaced, whoever wrote them.
  explicit Claims(Neighbours known, bool force = false) : files_(std::move(known)), force_(force) {}

  /// Claims outputs whose names only turned out when a source was read. ErrorClass::usage if one is taken.
  Result<void> add(const std::vector<std::string>& outputs);
  /// Whether a scene may be written to `path`: ErrorClass::output if there is one that was written or edited by hand.
  Result<void> check_scene(const std::string& path) const;

 private:
  std::mutex mutex_;
  Neighbours files_;
  const bool force_;
};

/// Whether `output` names a folder: it ends in / or is one.
bool names_folder(const std::string& output);

/// A job for each input. ErrorClass::usage for several inputs and an output that is no folder, or for two inputs with
/// one output.
Result<std::vector<Job>> plan_jobs(const std::vector<std::string>& inputs, const std::string& output);

}  // namespace kd::tools
