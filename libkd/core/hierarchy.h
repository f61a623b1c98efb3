// The scene level: a binary tree of boxes over instances, in scene space and float32, and the ray test that walks it.
// It leaves out no box that the ray passes; a box that it lets through for nothing costs time and no exactness, because
// whether the ray meets an instance is decided in the instance's lattice.
#pragma once

#include <cstdint>

#include "core/arithmetic.h"
#include "core/box.h"
#include "core/ray.h"
#include "core/vec.h"

namespace kd {

/// 32 bytes; the two children of a node side by side are 64.
struct alignas(16) HierarchyNode {
  Vec3f lo;
  uint32_t first = 0;  // inner: index of the first child, the second follows; leaf: an instance
  Vec3f hi;
  uint32_t is_leaf = 0;  // 1 or 0

  Box3f box() const { return {lo, hi}; }
};

constexpr int kMaxHierarchyDepth = 64;

/// Distances at which a ray enters and leaves a box. Where either is NaN the ray counts as passing. Real is float, or
/// a packet's (core/packet.h).
template <class Real>
struct Passage {
  Real enter;
  Real leave;

  KD_HD KD_INLINE auto passes() const { return !(enter > leave); }
};

/// A ray against boxes within some bounds: never enters a box later, nor leaves it earlier, than the ray in exact
/// arithmetic does.
///
/// Of a box's plane p and the ray's origin o and direction d, the distance (p - o) / d is computed as one fused
/// multiply-add, p * inverse + offset. With e = 2^-24 and |p| <= P, what rounding does to the inverse, to the offset
/// and to the sum is at most 2e (P + |o|) / |d|, to terms of e; twice that, 2^-22 (P + |o|) / |d|, is subtracted from
/// the offset for planes that the ray enters by and added for those it leaves by. (Underflow: 2^-146 more.) A component
/// of the direction of less than 2^-60 of the largest counts as that much, which moves no point within the bounds by as
/// much as that margin. Real is float, or
/// a packet's for rays that rise along the same axes (core/packet.h).
template <class Real>
struct BoxTest {
  Vec3<Real> inverse, enter, leave;
  Real t_min;
  bool rising_x, rising_y, rising_z;

  KD_HD KD_INLINE Passage<Real> pass(const HierarchyNode& node, Real t_limit) const {
    const Vec3f first{rising_x ? node.lo.x : node.hi.x, rising_y ? node.lo.y : node.hi.y,
                      rising_z ? node.lo.z : node.hi.z};
    const Vec3f last{rising_x ? node.hi.x : node.lo.x, rising_y ? node.hi.y : node.lo.y,
                     rising_z ? node.hi.z : node.lo.z};
    const auto distance = [](float plane, Real per_unit, Real offset) {
      using std::fma;
      return fma(Real(plane), per_unit, offset);
    };
    return {largest_of(largest_of(distance(first.x, inverse.x, enter.x), distance(first.y, inverse.y, enter.y)),
                       largest_of(distance(first.z, inverse.z, enter.z), t_min)),
            least_of(least_of(distance(last.x, inverse.x, leave.x), distance(last.y, inverse.y, leave.y)),
                     least_of(distance(last.z, inverse.z, leave.z), t_limit))};
  }
};

/// Of one ray, or of a packet's but for what rises; `bounds` holds all boxes.
template <class Double>
KD_HD KD_INLINE auto slabs_of(const BasicRay<Double>& ray, const HierarchyNode& bounds) {
  using std::copysign, std::fabs;
  BoxTest<decltype(to_float(Double{}))> test;
  test.t_min = -rounded_up(-ray.t_min);
  const Vec3<Double> d = ray.direction;
  const Double largest = max_of(fabs(d.x), fabs(d.y), fabs(d.z)), least = 0x1p-60 * largest;
  const auto set = [&](int axis) {
    const Double o = ray.origin[axis], per_unit = 1 / copysign(max_of(fabs(d[axis]), least), d[axis]);
    const float extent = largest_of(std::fabs(bounds.lo[axis]), std::fabs(bounds.hi[axis]));
    const Double margin = (extent + fabs(o)) * (0x1p-22 * fabs(per_unit) + 0x1p-146) + 0x1p-146;
    test.inverse.set(axis, to_float(per_unit));
    test.enter.set(axis, to_float(-o * per_unit - margin));
    test.leave.set(axis, to_float(-o * per_unit + margin));
  };
  set(0);
  set(1);
  set(2);
  return test;
}

KD_HD KD_INLINE BoxTest<float> box_test(const Ray& ray, const HierarchyNode& bounds) {
  BoxTest<float> test = slabs_of(ray, bounds);
  test.rising_x = ray.direction.x >= 0;
  test.rising_y = ray.direction.y >= 0;
  test.rising_z = ray.direction.z >= 0;
  return test;
}

}  // namespace kd
