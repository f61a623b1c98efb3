// Scalar operations with one meaning on every compiler. The library's fmin and fmax are calls on some hosts, because of
// what they promise for NaN; a comparison is one instruction everywhere and its answer for NaN is plain: the second
// operand.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "core/platform.h"

namespace kd {

template <class T>
KD_HD KD_INLINE constexpr T min_of(T a, T b) {
  return a < b ? a : b;
}
template <class T>
KD_HD KD_INLINE constexpr T max_of(T a, T b) {
  return a > b ? a : b;
}
template <class T>
KD_HD KD_INLINE constexpr T min_of(T a, T b, T c) {
  return min_of(min_of(a, b), c);
}
template <class T>
KD_HD KD_INLINE constexpr T max_of(T a, T b, T c) {
  return max_of(max_of(a, b), c);
}

/// The least and the largest of numbers none of which is NaN. Of zeros of both signs either may come out, so they are
/// for bounds and comparisons, not for results. A device has one instruction for each.
KD_HD KD_INLINE float least_of(float a, float b) { return KD_ON_DEVICE ? fminf(a, b) : min_of(a, b); }
KD_HD KD_INLINE float largest_of(float a, float b) { return KD_ON_DEVICE ? fmaxf(a, b) : max_of(a, b); }
KD_HD KD_INLINE float least_of(float a, float b, float c) { return least_of(least_of(a, b), c); }
KD_HD KD_INLINE float largest_of(float a, float b, float c) { return largest_of(largest_of(a, b), c); }

/// The least float32 that is not below x.
KD_HD KD_INLINE float rounded_up(float x) { return x; }
KD_HD KD_INLINE float rounded_up(double x) {
#if KD_ON_DEVICE
  return __double2float_ru(x);
#else
  const auto nearest = static_cast<float>(x);
  if (!(nearest < x)) return nearest;
  const auto bits = std::bit_cast<uint32_t>(nearest);
  return std::bit_cast<float>(nearest < 0 ? bits - 1 : bits + 1);
#endif
}

}  // namespace kd
