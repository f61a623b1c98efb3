// Scalar operations with one meaning on every compiler. The library's fmin and fmax are calls on some hosts, because of
// what they promise for NaN; a comparison is one instruction everywhere and its answer for NaN is plain: the second
// operand.
#pragma once

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

}  // namespace kd
