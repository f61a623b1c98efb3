#include "sys/hash.h"

#include <fmt/format.h>
#include <xxhash.h>

namespace kd {

uint64_t hash_bytes(const void* data, size_t size) { return XXH3_64bits(data, size); }

std::string hash_text(uint64_t hash) { return fmt::format("{:016x}", hash); }

}  // namespace kd
