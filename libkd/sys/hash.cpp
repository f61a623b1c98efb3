#include "sys/hash.h"

#include <algorithm>
#include <memory>
#include <new>

#include <fmt/format.h>
#include <xxhash.h>

namespace kd {

uint64_t hash_bytes(const void* data, size_t size) { return XXH3_64bits(data, size); }

std::optional<uint64_t> hash_bytes(const void* data, size_t size, const Progress& progress) {
  constexpr size_t kPiece = size_t{1} << 23;
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), XXH3_freeState);
  if (!state) throw std::bad_alloc();
  XXH3_64bits_reset(state.get());
  for (size_t at = 0; at < size; at += kPiece) {
    if (!keep_going(progress, 0)) return std::nullopt;
    XXH3_64bits_update(state.get(), static_cast<const std::byte*>(data) + at, std::min(kPiece, size - at));
  }
  return XXH3_64bits_digest(state.get());
}

std::string hash_text(uint64_t hash) { return fmt::format("{:016x}", hash); }

}  // namespace kd
