// XXH3, 64 bits: the checksums of a .nkd's sections and the fingerprints of sources.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "sys/progress.h"

namespace kd {

uint64_t hash_bytes(const void* data, size_t size);
/// The same; asks `progress` every few milliseconds, with a share of 0, and gives nothing once it cancels.
std::optional<uint64_t> hash_bytes(const void* data, size_t size, const Progress& progress);

template <class T>
uint64_t hash_span(std::span<const T> s) {
  return hash_bytes(s.data(), s.size_bytes());
}

/// Sixteen lower-case hexadecimal digits.
std::string hash_text(uint64_t hash);

}  // namespace kd
