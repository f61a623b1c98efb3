#include "kdbuild/fingerprint.h"

#include <algorithm>
#include <functional>
#include <iterator>

#include "mesh/dependencies.h"
#include "sys/hash.h"
#include "sys/mapped_file.h"

namespace kd::tools {

namespace {

Result<Fingerprint> with_dependencies(const std::string& input, std::span<const std::byte> bytes,
                                      std::vector<std::string> named, const Progress& progress) {
  std::vector<uint64_t> hashes;
  const auto add = [&](std::span<const std::byte> file) {
    const auto hash = hash_bytes(file.data(), file.size(), progress);
    hashes.push_back(hash.value_or(0));
    return hash.has_value();
  };
  const Error interrupted{ErrorClass::interrupted, input, "interrupted"};
  if (!add(bytes)) return interrupted;
  Fingerprint out{hashes[0], std::move(named), {input}};
  if (out.named.empty()) return out;
  for (const std::string& name : out.named) {
    const auto file = MappedFile::open(name);
    if (!file) hashes.push_back(0);
    if (file && !add(file->bytes())) return interrupted;
    if (file) out.files.push_back(name);
  }
  out.hash = hash_span(std::span<const uint64_t>(hashes));
  return out;
}

}  // namespace

Result<Fingerprint> fingerprint(const std::string& input, const Progress& progress) {
  const auto file = MappedFile::open(input);
  if (!file) return file.error();
  auto named = mesh::dependencies(file->bytes(), input, progress);
  if (!named) return named.error();
  return with_dependencies(input, file->bytes(), std::move(*named), progress);
}

Result<Fingerprint> extended(const std::string& input, Fingerprint known, const std::vector<std::string>& dependencies,
                             const Progress& progress) {
  const auto is_known = [&](const std::string& file) {
    return std::find(known.named.begin(), known.named.end(), file) != known.named.end();
  };
  std::vector<std::string> named = known.named;
  std::copy_if(dependencies.begin(), dependencies.end(), std::back_inserter(named), std::not_fn(is_known));
  if (named.size() == known.named.size()) return known;
  const auto file = MappedFile::open(input);
  if (!file) return file.error();
  return with_dependencies(input, file->bytes(), std::move(named), progress);
}

}  // namespace kd::tools
