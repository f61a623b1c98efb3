// XXH3, 64 bits: the checksums of a .nkd's sections and the fingerprints of sources.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace kd {

uint64_t hash_bytes(const void* data, size_t size);

template <class T>
uint64_t hash_span(std::span<const T> s) {
  return hash_bytes(s.data(), s.size_bytes());
}

/// Sixteen lower-case hexadecimal digits.
std::string hash_text(uint64_t hash);

}  // namespace kd
