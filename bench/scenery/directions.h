// Directions by chance, and noise: from integers, +, -, x, / and square roots alone, so that every machine grows the
// same forest. As of Random, an expression asks for one of them at most: compilers evaluate operands and arguments in
// orders of their own.
#pragma once

#include <cmath>

#include "core/vec.h"
#include "stress/random.h"

namespace kd::bench::scenery {

using stress::Random;

constexpr Vec3d kUp{0, 1, 0};

/// Any direction, of length 1.
inline Vec3d any_direction(Random& random) {
  for (;;) {
    const Vec3d v = random.vector(1);
    const double square = dot(v, v);
    if (square > 0.01 && square < 1) return v * (1 / std::sqrt(square));
  }
}

/// Perpendicular to `axis`, of length 1.
inline Vec3d any_across(Vec3d axis, Random& random) {
  for (;;) {
    const Vec3d v = any_direction(random);
    const Vec3d across = cross(axis, v);
    if (dot(across, across) > 0.01 * dot(axis, axis)) return normalised(across);
  }
}

/// 0 up to `lo`, 1 from `hi` on, without an edge.
inline double smooth_step(double lo, double hi, double x) {
  const double t = std::fmin(std::fmax((x - lo) / (hi - lo), 0), 1);
  return t * t * (3 - 2 * t);
}

/// Value noise in [-1, 1], smooth, with cells of length 1; each layer is a noise of its own.
inline double noise(Vec3d p, uint64_t layer) {
  const Vec3d cell{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
  const auto fade = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
  const Vec3d at = p - cell;
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const bool right = (corner & 1) != 0, top = (corner & 2) != 0, back = (corner & 4) != 0;
    const auto number = [](double c, bool next) {
      return static_cast<uint64_t>(static_cast<int64_t>(c) + (next ? 1 : 0));
    };
    const uint64_t key = stress::scatter(number(cell.x, right)) + 3 * stress::scatter(~number(cell.y, top)) +
                         5 * stress::scatter(number(cell.z, back) ^ 0x5555);
    const double weight = fade(right ? at.x : 1 - at.x) * fade(top ? at.y : 1 - at.y) * fade(back ? at.z : 1 - at.z);
    sum += weight * (Random(layer, key).unit() * 2 - 1);
  }
  return sum;
}

}  // namespace kd::bench::scenery
