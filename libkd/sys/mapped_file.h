// A file mapped into memory, read-only.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "sys/result.h"

namespace kd {

class MappedFile {
 public:
  /// How a file will be read.
  enum class Access {
    whole,  // the system may read ahead of what is touched, megabytes at a time
    sparse  // from disk come the pages that are touched or announced, no others
  };

  MappedFile() = default;
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  ~MappedFile();

  /// ErrorClass::missing if the path is not a readable regular file. An empty file maps to no bytes.
  static Result<MappedFile> open(const std::string& path, Access access = Access::whole);

  std::span<const std::byte> bytes() const { return {data_, size_}; }

  /// Announces that a part of bytes() is about to be read whole: what is not in memory starts to come. No effect on
  /// what is read, only on when.
  void will_read(std::span<const std::byte> part) const;

 private:
  const std::byte* data_ = nullptr;
  size_t size_ = 0;
};

}  // namespace kd
