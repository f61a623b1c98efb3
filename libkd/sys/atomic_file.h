// Output that is never half-written: bytes go to a file beside the final name, which is renamed into place when it is
// whole. A run that fails or is killed leaves what was there before.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "sys/result.h"

namespace kd {

/// A name beside `path` to write to. `commit` moves what was written there into place; without it the destructor
/// removes it. For writers that open files by name themselves.
class AtomicFile {
 public:
  /// Claims the temporary name. ErrorClass::output if the folder does not exist or cannot be written to, or `path`
  /// names something else than a file.
  static Result<AtomicFile> create(const std::string& path);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();

  const std::string& temporary_path() const { return temporary_; }
  /// Flushes the temporary file to disk and renames it to the final name.
  Result<void> commit();

 private:
  AtomicFile(std::string path, std::string temporary);

  std::string path_;
  std::string temporary_;  // empty once committed or moved from
};

/// Whether `path` could be written now, as AtomicFile::create would say: for finding out before working for minutes.
Result<void> check_writable(const std::string& path);

/// All of `bytes` as the file `path`, atomically.
Result<void> write_file(const std::string& path, std::span<const std::byte> bytes);
Result<void> write_file(const std::string& path, const std::string& text);

}  // namespace kd
