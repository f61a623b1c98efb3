// Random numbers that are a function of a ray's number: a CPU and a GPU make the same rays, in any order, and none is
// stored. An expression asks for one number at most: compilers evaluate operands in orders of their own. SplitMix64
// (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014).
#pragma once

#include <cstdint>

#include "core/vec.h"

namespace kd::stress {

KD_HD KD_INLINE uint64_t scatter(uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

class Random {
 public:
  /// The sequence of element `index` of the stream `seed`.
  KD_HD KD_INLINE Random(uint64_t seed, uint64_t index) : state_(scatter(seed + 0x9e3779b97f4a7c15u * index)) {}

  KD_HD KD_INLINE uint64_t word() { return scatter(state_ += 0x9e3779b97f4a7c15u); }
  /// In [0, 1).
  KD_HD KD_INLINE double unit() { return static_cast<double>(word() >> 11) * 0x1p-53; }
  KD_HD KD_INLINE double real(double lo, double hi) { return lo + unit() * (hi - lo); }
  /// In [0, count), count > 0.
  KD_HD KD_INLINE uint32_t below(uint32_t count) { return static_cast<uint32_t>(((word() >> 32) * count) >> 32); }
  KD_HD KD_INLINE bool chance(double p) { return unit() < p; }
  KD_HD KD_INLINE double sign() { return (word() & 1) != 0 ? 1 : -1; }
  KD_HD KD_INLINE Vec3d vector(double size) {
    const double x = real(-size, size), y = real(-size, size);
    return {x, y, real(-size, size)};
  }
  /// 10^e times a number in [1, 2), e evenly in [lo, hi]: by whole powers of ten, so that no libm is asked.
  KD_HD KD_INLINE double magnitude(int lo, int hi) {
    double m = real(1, 2);
    const int e = lo + static_cast<int>(below(static_cast<uint32_t>(hi - lo + 1)));
    for (int i = 0; i < e; ++i) m *= 10;
    for (int i = 0; i > e; --i) m /= 10;
    return m;
  }
  /// The same, on either side of 0.
  KD_HD KD_INLINE double either_magnitude(int lo, int hi) {
    const double side = sign();
    return side * magnitude(lo, hi);
  }

 private:
  uint64_t state_;
};

}  // namespace kd::stress
