// Vectors of three: Vec3d for model and scene space, Vec3f for lattice space and colours, Vec3u for lattice points.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/arithmetic.h"
#include "core/platform.h"

namespace kd {

template <class T>
struct Vec3 {
  T x{}, y{}, z{};

  /// Component `axis` (0, 1 or 2), by selection rather than by address: a device keeps the vector in registers.
  KD_HD KD_INLINE constexpr T operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  KD_HD KD_INLINE constexpr void set(int axis, T value) { (axis == 0 ? x : axis == 1 ? y : z) = value; }

  friend bool operator==(const Vec3&, const Vec3&) = default;
};

using Vec3d = Vec3<double>;
using Vec3f = Vec3<float>;
using Vec3u = Vec3<uint32_t>;

template <class T>
KD_HD KD_INLINE constexpr Vec3<T> operator+(Vec3<T> a, Vec3<T> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
KD_HD KD_INLINE constexpr Vec3<T> operator-(Vec3<T> a, Vec3<T> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
KD_HD KD_INLINE constexpr Vec3<T> operator-(Vec3<T> a) {
  return {-a.x, -a.y, -a.z};
}
template <class T>
KD_HD KD_INLINE constexpr Vec3<T> operator*(Vec3<T> a, Vec3<T> b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class T>
KD_HD KD_INLINE constexpr Vec3<T> operator*(Vec3<T> a, T s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class T>
KD_HD KD_INLINE constexpr T dot(Vec3<T> a, Vec3<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
/// The same sum with two roundings less.
template <class T>
KD_HD KD_INLINE T fused_dot(Vec3<T> a, Vec3<T> b) {
  using std::fma;
  return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}
template <class T>
KD_HD KD_INLINE constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
KD_HD KD_INLINE T length(Vec3<T> a) {
  return std::sqrt(dot(a, a));
}
/// A vector as length and direction, of length 1; the zero vector is its own direction. Scaled by a power of two first,
/// so that no length between 1e-300 and 1e300 overflows or vanishes.
struct Polar {
  Vec3d direction;
  double length;
};
KD_HD KD_INLINE Polar polar(Vec3d a) {
  const double largest = max_of(std::fabs(a.x), std::fabs(a.y), std::fabs(a.z));
  if (!(largest > 0)) return {a, 0};
  const int exponent = min_of(exponent_of(largest), 1022);
  const Vec3d b = a * power_of_two(-exponent);
  const double l = length(b);
  return {b * reciprocal(l), l * power_of_two(exponent)};
}
KD_HD KD_INLINE Vec3d normalised(Vec3d a) { return polar(a).direction; }
template <class T = double>
KD_HD KD_INLINE Truth<T> is_finite(Vec3<T> a) {
  // x - x is 0 for a finite x and NaN for an infinity or a NaN.
  return (a.x - a.x) + (a.y - a.y) + (a.z - a.z) == 0;
}
template <class To, class From>
KD_HD KD_INLINE constexpr Vec3<To> vec_cast(Vec3<From> a) {
  return {static_cast<To>(a.x), static_cast<To>(a.y), static_cast<To>(a.z)};
}

}  // namespace kd
