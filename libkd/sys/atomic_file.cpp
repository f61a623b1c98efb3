#include "sys/atomic_file.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace kd {

namespace {

Error output_error(const std::string& path, const char* action) {
  return {ErrorClass::output, path, std::string("cannot ") + action + ": " + std::strerror(errno)};
}

}  // namespace

AtomicFile::AtomicFile(std::string path, std::string temporary)
    : path_(std::move(path)), temporary_(std::move(temporary)) {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)), temporary_(std::exchange(other.temporary_, {})) {}

AtomicFile::~AtomicFile() {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

Result<AtomicFile> AtomicFile::create(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
    return Error{ErrorClass::output, path,
                 S_ISDIR(status.st_mode) ? "cannot write: it is a folder" : "cannot write: it is not a regular file"};
  }
  std::string temporary = path + ".XXXXXX";
  const int descriptor = ::mkstemp(temporary.data());
  if (descriptor < 0) return output_error(path, "write");
  // mkstemp makes private files; give the result the permissions that any new file would have. The mask is asked for
  // once: asking sets it for a moment, and of two threads that ask at a time one would see, and leave, what the other
  // set.
  static const mode_t mask = [] {
    const mode_t current = ::umask(0);
    ::umask(current);
    return current;
  }();
  ::fchmod(descriptor, 0666 & ~mask);
  ::close(descriptor);
  return AtomicFile(path, temporary);
}

Result<void> AtomicFile::commit() {
  const int descriptor = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return output_error(path_, "write");
  const bool flushed = ::fsync(descriptor) == 0;
  ::close(descriptor);
  if (!flushed || ::rename(temporary_.c_str(), path_.c_str()) != 0) return output_error(path_, "write");
  temporary_.clear();
  return {};
}

Result<void> check_writable(const std::string& path) {
  auto file = AtomicFile::create(path);
  if (!file) return file.error();
  return {};
}

Result<void> write_file(const std::string& path, std::span<const std::byte> bytes) {
  auto file = AtomicFile::create(path);
  if (!file) return file.error();
  std::FILE* stream = std::fopen(file->temporary_path().c_str(), "wb");
  if (!stream) return output_error(path, "write");
  // An empty span may have no address, which fwrite must not be given.
  const bool written = bytes.empty() || std::fwrite(bytes.data(), 1, bytes.size(), stream) == bytes.size();
  if (std::fclose(stream) != 0 || !written) return output_error(path, "write");
  return file->commit();
}

Result<void> write_file(const std::string& path, const std::string& text) {
  return write_file(path, std::as_bytes(std::span(text)));
}

}  // namespace kd
