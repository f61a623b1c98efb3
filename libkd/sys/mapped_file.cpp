#include "sys/mapped_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace kd {

MappedFile::MappedFile(MappedFile&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  return *this;
}

MappedFile::~MappedFile() {
  if (data_) munmap(const_cast<std::byte*>(data_), size_);
}

Result<MappedFile> MappedFile::open(const std::string& path, Access access) {
  const auto failed = [&](const std::string& why) { return Error{ErrorClass::missing, path, why}; };
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // a named pipe must not block
  if (descriptor < 0) return failed(std::string("cannot open: ") + std::strerror(errno));
  struct stat status {};
  if (fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor);
    return failed("not a regular file");
  }
  MappedFile file;
  file.size_ = static_cast<size_t>(status.st_size);
  if (file.size_ > 0) {
    void* address = mmap(nullptr, file.size_, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (address != MAP_FAILED) file.data_ = static_cast<const std::byte*>(address);
  }
  const int map_error = errno;
  if (file.data_ && access == Access::sparse) madvise(const_cast<std::byte*>(file.data_), file.size_, MADV_RANDOM);
  ::close(descriptor);
  if (file.size_ > 0 && !file.data_) return failed(std::string("cannot map: ") + std::strerror(map_error));
  return file;
}

void MappedFile::will_read(std::span<const std::byte> part) const {
  // Linux takes no more of one call than a disk's read-ahead, which is 128 KiB where nobody has changed it.
  constexpr size_t kPiece = size_t{128} << 10;
  if (part.empty()) return;
  const auto page = static_cast<size_t>(sysconf(_SC_PAGESIZE)), first = static_cast<size_t>(part.data() - data_);
  const size_t end = first + part.size();
  for (size_t at = first / page * page; at < end; at += kPiece) {
    madvise(const_cast<std::byte*>(data_ + at), std::min(kPiece, end - at), MADV_WILLNEED);
  }
}

}  // namespace kd
