// A file mapped into memory, read-only. Pages that nobody reads are never read from disk.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "sys/result.h"

namespace kd {

class MappedFile {
 public:
  MappedFile() = default;
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  ~MappedFile();

  /// ErrorClass::missing if the path is not a readable regular file. An empty file maps to no bytes.
  static Result<MappedFile> open(const std::string& path);

  std::span<const std::byte> bytes() const { return {data_, size_}; }

 private:
  const std::byte* data_ = nullptr;
  size_t size_ = 0;
};

}  // namespace kd
