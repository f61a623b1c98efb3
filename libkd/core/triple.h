// Three numbers of so many bits each, packed: lattice points, and the corners of a triangle.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/vec.h"

namespace kd {

/// 32-bit words that three numbers of `bits` bits take: one up to 10 bits, two up to 21, three above.
KD_HD KD_INLINE constexpr int triple_words(int bits) { return bits <= 10 ? 1 : bits <= 21 ? 2 : 3; }

/// Stores `triple_words(bits)` little-endian words: x in the lowest bits, then y, then z; one word each where they do
/// not fit 64 bits.
inline void pack_triple(Vec3u t, int bits, uint32_t* words) {
  if (triple_words(bits) == 3) {
    words[0] = t.x;
    words[1] = t.y;
    words[2] = t.z;
    return;
  }
  const uint64_t packed = uint64_t{t.x} | uint64_t{t.y} << bits | uint64_t{t.z} << (2 * bits);
  words[0] = static_cast<uint32_t>(packed);
  if (bits > 10) words[1] = static_cast<uint32_t>(packed >> 32);
}

KD_HD KD_INLINE Vec3u unpack_triple(const uint32_t* words, int bits) {
  if (bits > 21) return {words[0], words[1], words[2]};
  uint64_t packed = words[0];
  if (bits > 10) packed |= static_cast<uint64_t>(words[1]) << 32;
  const uint64_t mask = (uint64_t{1} << bits) - 1;
  return {static_cast<uint32_t>(packed & mask), static_cast<uint32_t>(packed >> bits & mask),
          static_cast<uint32_t>(packed >> (2 * bits) & mask)};
}

/// All of these triples, one behind the other.
inline std::vector<uint32_t> pack_triples(std::span<const Vec3u> triples, int bits) {
  const auto words = static_cast<size_t>(triple_words(bits));
  std::vector<uint32_t> packed(triples.size() * words);
  for (size_t i = 0; i < triples.size(); ++i) pack_triple(triples[i], bits, &packed[i * words]);
  return packed;
}
inline std::vector<uint32_t> pack_triples(std::span<const std::array<uint32_t, 3>> triples, int bits) {
  const auto words = static_cast<size_t>(triple_words(bits));
  std::vector<uint32_t> packed(triples.size() * words);
  for (size_t i = 0; i < triples.size(); ++i) {
    pack_triple({triples[i][0], triples[i][1], triples[i][2]}, bits, &packed[i * words]);
  }
  return packed;
}

}  // namespace kd
