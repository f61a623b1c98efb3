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

/// The least and the largest of two numbers; where the first is NaN, the second. Of zeros of both signs either may come
/// out, so they are for bounds and comparisons, not for results. A device has one instruction for each.
KD_HD KD_INLINE float least_of(float a, float b) { return KD_ON_DEVICE ? fminf(a, b) : min_of(a, b); }
KD_HD KD_INLINE float largest_of(float a, float b) { return KD_ON_DEVICE ? fmaxf(a, b) : max_of(a, b); }
KD_HD KD_INLINE float least_of(float a, float b, float c) { return least_of(least_of(a, b), c); }
KD_HD KD_INLINE float largest_of(float a, float b, float c) { return largest_of(largest_of(a, b), c); }

/// For code that computes with a number or with a packet's (core/packet.h): what a comparison returns, and what is done
/// with it.
template <class T>
using Truth = decltype(T{} < T{});
template <class T>
KD_HD KD_INLINE constexpr T select(bool which, T a, T b) {
  return which ? a : b;
}
KD_HD KD_INLINE constexpr bool any(bool holds) { return holds; }
KD_HD KD_INLINE constexpr float to_float(double x) { return static_cast<float>(x); }

/// Whether not all of three numbers have the same sign bit.
KD_HD KD_INLINE bool signs_differ(float a, float b, float c) {
  const auto bits = [](float x) { return std::bit_cast<uint32_t>(x); };
  return (((bits(a) ^ bits(b)) | (bits(b) ^ bits(c))) & 0x80000000u) != 0;
}

/// 1 / x, rounded to nearest, for |x| in [2^-100, 2^100]. A device's own division takes as long again to find out
/// whether x is in such a range; on an H100 the two agree for every significand.
KD_HD KD_INLINE float reciprocal(float x) {
#if KD_ON_DEVICE
  float approximate;
  asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(approximate) : "f"(x));
  return fmaf(approximate, fmaf(-x, approximate, 1.0f), approximate);
#else
  return 1 / x;
#endif
}

/// 1 / x to 2^-52 of itself, for |x| in [2^-100, 2^100]: from that of the nearest float32, by one step of third order.
template <class Double>
KD_HD KD_INLINE Double reciprocal(Double x) {
  using std::fma;
  const Double first = reciprocal(to_float(x)), error = fma(-x, first, Double(1));
  return fma(first, fma(error, error, error), first);
}

/// 2^exponent, for a normal one.
KD_HD KD_INLINE double power_of_two(int exponent) {
  return std::bit_cast<double>(static_cast<uint64_t>(1023 + exponent) << 52);
}

/// Of a finite x > 0, as a double's bits have it: -1023 for denormal ones.
KD_HD KD_INLINE int exponent_of(double x) { return static_cast<int>(std::bit_cast<uint64_t>(x) >> 52) - 1023; }

/// The multiple of `grid`, a power of two, that is nearest to x, the even one of two, if |x| < 2^51 grid; beyond that
/// some number near x. Two additions, where a device takes a conversion's time for rint.
template <class Double>
KD_HD KD_INLINE Double rounded_to(Double x, double grid) {
  const double shift = 0x1.8p52 * grid;  // doubles around it are multiples of the grid
  return (x + shift) - shift;
}

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
