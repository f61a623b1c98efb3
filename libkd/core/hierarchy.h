// The scene level: a binary tree of boxes over instances, in scene space and double, and the ray test that walks it.
#pragma once

#include <cstdint>

#include "core/arithmetic.h"
#include "core/ray.h"
#include "core/vec.h"

namespace kd {

struct HierarchyNode {
  Vec3d lo;
  Vec3d hi;
  uint32_t first = 0;    // inner: index of the first child, the second follows; leaf: an instance
  uint32_t is_leaf = 0;  // 1 or 0
};

constexpr int kMaxHierarchyDepth = 64;

/// Distances at which a ray enters and leaves a box; it misses if enter > leave.
struct Passage {
  double enter;
  double leave;
};

/// `inverse` is 1 / direction by component, +-1e300 where that is beyond it: a zero component must not make a NaN.
KD_HD KD_INLINE Passage pass_box(const HierarchyNode& node, Vec3d origin, Vec3d inverse, double t_min, double t_max) {
  Passage p{t_min, t_max};
  for (int axis = 0; axis < 3; ++axis) {
    const double t0 = (node.lo[axis] - origin[axis]) * inverse[axis];
    const double t1 = (node.hi[axis] - origin[axis]) * inverse[axis];
    p.enter = max_of(p.enter, min_of(t0, t1));
    p.leave = min_of(p.leave, max_of(t0, t1));
  }
  return p;
}

KD_HD KD_INLINE Vec3d inverse_direction(Vec3d d) {
  const auto one = [](double c) { return std::fabs(c) > 1e-300 ? 1 / c : c < 0 ? -1e300 : 1e300; };
  return {one(d.x), one(d.y), one(d.z)};
}

}  // namespace kd
