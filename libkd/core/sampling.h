// Where the samples of a pixel lie: Sobol's first two dimensions, scrambled in Owen's manner for each pixel anew,
// warped to a tent. Integers up to the last step, so the same on every device; a sample depends on its pixel and its
// number, not on how a frame is divided.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/arithmetic.h"

namespace kd {

/// Of a sample, from its pixel's centre, in pixels.
struct SampleOffset {
  double x;
  double y;
};

namespace detail {

KD_HD KD_INLINE uint32_t reversed_bits(uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0xff00ff00u) >> 8) | ((x & 0x00ff00ffu) << 8);
  x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
  return ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
}

/// Every bit of the result depends on every bit of x (C. Wellons, "Prospecting for hash functions", 2018: lowbias32).
KD_HD KD_INLINE uint32_t hashed(uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

/// Nested uniform scrambling: whether a bit is flipped depends on the bits above it and on the seed, so what was
/// stratified stays so. Laine and Karras, "Stratified sampling for stochastic transparency" (2011), with the constants
/// of N. Vegdahl (2021) that Burley's "Practical hash-based Owen scrambling" (JCGT 2020) led to.
KD_HD KD_INLINE uint32_t owen_scrambled(uint32_t x, uint32_t seed) {
  x = reversed_bits(x);
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return reversed_bits(x);
}

/// The second dimension of Sobol's sequence; the first is reversed_bits(index).
KD_HD KD_INLINE uint32_t sobol_second(uint32_t index) {
  uint32_t x = 0;
  for (uint32_t direction = 1u << 31; index != 0; index >>= 1, direction ^= direction >> 1) {
    if (index & 1) x ^= direction;
  }
  return x;
}

/// From u, of 32 bits, uniform, to [-1, 1] with the density of a tent: its inverse cumulative distribution.
KD_HD KD_INLINE double tent(uint32_t u) {
  const double v = (u + 0.5) * 0x1p-31;  // in (0, 2)
  return v < 1 ? std::sqrt(v) - 1 : 1 - std::sqrt(2 - v);
}

}  // namespace detail

/// Sample `index` of the film's pixel. Samples that are distributed like the reconstruction filter all weigh the same
/// (Ernst, Stamminger and Greiner, "Filter importance sampling", 2006); the filter is the tent of radius 1.
KD_HD KD_INLINE SampleOffset sample_offset(uint32_t column, uint32_t row, uint32_t index) {
  const uint32_t seed = detail::hashed(column ^ detail::hashed(row ^ 0x9e3779b9u));  // 0 would scramble nothing
  const uint32_t x = detail::owen_scrambled(detail::reversed_bits(index), seed);
  const uint32_t y = detail::owen_scrambled(detail::sobol_second(index), detail::hashed(seed));
  return {detail::tent(x), detail::tent(y)};
}

}  // namespace kd
