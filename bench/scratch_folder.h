// A folder for files that a measurement needs and nobody keeps: removed with its owner.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>

#include "sys/result.h"

namespace kd::bench {

class ScratchFolder {
 public:
  /// In the system's folder for temporary files. ErrorClass::output.
  static Result<ScratchFolder> create() {
    std::error_code failure;
    const std::filesystem::path parent = std::filesystem::temp_directory_path(failure);
    std::string path = (parent / "kdbench-XXXXXX").string();
    if (failure || !mkdtemp(path.data())) {
      return Error{ErrorClass::output, parent.string(),
                   "cannot make a temporary folder: set TMPDIR to one that can be written to"};
    }
    return ScratchFolder(std::move(path));
  }
  ScratchFolder(ScratchFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  ScratchFolder& operator=(ScratchFolder&&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }

  const std::string& path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  explicit ScratchFolder(std::string path) : path_(std::move(path)) {}

  std::string path_;
};

}  // namespace kd::bench
