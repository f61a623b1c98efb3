// Names of meshes, made fit to be parts of file names.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>

namespace kd::mesh {

/// No two names that it gives are the same, also without regard to case. The same wishes in the same order get the same
/// names.
class FileNames {
 public:
  /// `wish` with letters, digits, `-`, `_` and `.` as they are and every other character as `_`, at most 80 bytes,
  /// never empty and with neither `.` nor `-` in front. One that is taken gets a number behind it.
  std::string give(std::string_view wish);

 private:
  std::unordered_map<std::string, uint64_t> taken_;  // in lower case: the number of the last clash
};

}  // namespace kd::mesh
