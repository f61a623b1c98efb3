#include "kdbuild/fingerprint.h"

#include <algorithm>
#include <functional>
#include <iterator>

#include "mesh/dependencies.h"
#include "sys/hash.h"
#include "sys/mapped_file.h"

namespace kd::tools {

namespace {

Fingerprint with_dependencies(const std::string& input, std::span<const std::byte> bytes,
                              std::vector<std::string> named) {
  Fingerprint out{hash_span(bytes), std::move(named), {input}};
  if (out.named.empty()) return out;
  std::vector<uint64_t> hashes{out.hash};
  for (const std::string& name : out.named) {
    const auto file = MappedFile::open(name);
    hashes.push_back(file ? hash_span(file->bytes()) : 0);
    if (file) out.files.push_back(name);
  }
  out.hash = hash_span(std::span<const uint64_t>(hashes));
  return out;
}

}  // namespace

Result<Fingerprint> fingerprint(const std::string& input) {
  const auto file = MappedFile::open(input);
  if (!file) return file.error();
  return with_dependencies(input, file->bytes(), mesh::dependencies(file->bytes(), input));
}

Result<Fingerprint> extended(const std::string& input, Fingerprint known,
                             const std::vector<std::string>& dependencies) {
  const auto is_known = [&](const std::string& file) {
    return std::find(known.named.begin(), known.named.end(), file) != known.named.end();
  };
  std::vector<std::string> named = known.named;
  std::copy_if(dependencies.begin(), dependencies.end(), std::back_inserter(named), std::not_fn(is_known));
  if (named.size() == known.named.size()) return known;
  const auto file = MappedFile::open(input);
  if (!file) return file.error();
  return with_dependencies(input, file->bytes(), std::move(named));
}

}  // namespace kd::tools
