// Three numbers of so many bits each, packed: lattice points, and the corners of a triangle.
//
// A triple is a little-endian number of 3 x bits bits, x in the lowest, in as few whole bytes as hold it: 8 for a point
// of 21 bits, 9 for one of 24. So triples stand at any address, and what follows the last one must be readable: a
// section of triples ends with kTripleMargin bytes of 0.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace kd {

/// Bytes of zeros behind the last triple of a section.
constexpr size_t kTripleMargin = 16;

/// Bytes that three numbers of `bits` bits (1 to 32) take.
KD_HD KD_INLINE constexpr size_t triple_bytes(int bits) { return (3 * static_cast<size_t>(bits) + 7) / 8; }

namespace detail {

/// The eight bytes that start at any address; of a device's memory up to 11 from there on are read.
KD_HD KD_INLINE uint64_t load_unaligned(const uint8_t* from) {
#if defined(__CUDA_ARCH__)
  const auto address = reinterpret_cast<uintptr_t>(from);
  const auto* words = reinterpret_cast<const uint32_t*>(address & ~uintptr_t{3});
  const auto shift = static_cast<uint32_t>(address & 3) * 8;
  const uint32_t a = words[0], b = words[1], c = words[2];
  return static_cast<uint64_t>(__funnelshift_r(b, c, shift)) << 32 | __funnelshift_r(a, b, shift);
#else
  uint64_t value;
  std::memcpy(&value, from, sizeof value);
  return value;
#endif
}

/// Where the third number begins: a byte, and a bit in it.
KD_HD KD_INLINE constexpr size_t third_byte(int bits) { return static_cast<size_t>(2 * bits) / 8; }
KD_HD KD_INLINE constexpr int third_bit(int bits) { return 2 * bits % 8; }

}  // namespace detail

/// A section of packed triples, as it lies in a file or on a device.
struct PackedTriples {
  const uint8_t* bytes = nullptr;
  int bits = 1;

  KD_HD KD_INLINE Vec3u operator[](uint64_t i) const {
    const uint8_t* at = bytes + i * triple_bytes(bits);
    const uint64_t mask = (uint64_t{1} << bits) - 1;
    const uint64_t low = detail::load_unaligned(at), high = detail::load_unaligned(at + detail::third_byte(bits));
    return {static_cast<uint32_t>(low & mask), static_cast<uint32_t>(low >> bits & mask),
            static_cast<uint32_t>(high >> detail::third_bit(bits) & mask)};
  }
};

/// How many triples a section of this size holds.
constexpr size_t triple_count(size_t section_bytes, int bits) {
  return section_bytes < kTripleMargin ? 0 : (section_bytes - kTripleMargin) / triple_bytes(bits);
}
/// Whether a section of this size holds triples and nothing else.
constexpr bool is_triples(size_t section_bytes, int bits) {
  return section_bytes >= kTripleMargin && (section_bytes - kTripleMargin) % triple_bytes(bits) == 0;
}

/// Packs all of these triples into a section; `Triple` has three numbers below 2^bits under [].
template <class Triple>
std::vector<uint8_t> pack_triples(const std::vector<Triple>& triples, int bits) {
  std::vector<uint8_t> section(triples.size() * triple_bytes(bits) + kTripleMargin);
  uint8_t* at = section.data();
  const auto put = [](uint8_t* to, uint64_t value) {
    value |= detail::load_unaligned(to);
    std::memcpy(to, &value, sizeof value);
  };
  for (const Triple& t : triples) {
    put(at, uint64_t{t[0]} | uint64_t{t[1]} << bits);
    put(at + detail::third_byte(bits), uint64_t{t[2]} << detail::third_bit(bits));
    at += triple_bytes(bits);
  }
  return section;
}
}  // namespace kd
