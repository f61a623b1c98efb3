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

/// Distances at which a ray enters and leaves a box. Where either is NaN the ray counts as passing.
struct Passage {
  float enter;
  float leave;

  KD_HD KD_INLINE bool passes() const { return !(enter > leave); }
};

/// A ray against boxes within some bounds: never enters a box later, nor leaves it earlier, than the ray in exact
/// arithmetic does.
///
/// Of a box's plane p and the ray's origin o and direction d, the distance (p - o) / d is computed as one fused
/// multiply-add, p * inverse + offset. With e = 2^-24 and |p| <= P, what rounding does to the inverse, to the offset
/// and to the sum is at most 2e (P + |o|) / |d|, to terms of e; twice that, 2^-22 (P + |o|) / |d|, is subtracted from
/// the offset for planes that the ray enters by and added for those it leaves by. (Underflow: 2^-146 more.) A component
/// of the direction of less than 2^-60 of the largest counts as that much, which moves no point within the bounds by as
/// much as that margin.
class BoxTest {
 public:
  /// `bounds`: holds all boxes.
  KD_HD KD_INLINE BoxTest(const Ray& ray, const HierarchyNode& bounds)
      : t_min_(-rounded_up(-ray.t_min)),
        rising_x_(ray.direction.x >= 0),
        rising_y_(ray.direction.y >= 0),
        rising_z_(ray.direction.z >= 0) {
    const Vec3d d = ray.direction;
    const double least = 0x1p-60 * max_of(std::fabs(d.x), std::fabs(d.y), std::fabs(d.z));
    const auto set = [&](int axis) {
      const double o = ray.origin[axis], inverse = 1 / std::copysign(max_of(std::fabs(d[axis]), least), d[axis]);
      const float extent = largest_of(std::fabs(bounds.lo[axis]), std::fabs(bounds.hi[axis]));
      const double margin = (extent + std::fabs(o)) * (0x1p-22 * std::fabs(inverse) + 0x1p-146) + 0x1p-146;
      inverse_.set(axis, static_cast<float>(inverse));
      enter_.set(axis, static_cast<float>(-o * inverse - margin));
      leave_.set(axis, static_cast<float>(-o * inverse + margin));
    };
    set(0);
    set(1);
    set(2);
  }

  KD_HD KD_INLINE Passage pass(const HierarchyNode& node, float t_limit) const {
    const Vec3f first{rising_x_ ? node.lo.x : node.hi.x, rising_y_ ? node.lo.y : node.hi.y,
                      rising_z_ ? node.lo.z : node.hi.z};
    const Vec3f last{rising_x_ ? node.hi.x : node.lo.x, rising_y_ ? node.hi.y : node.lo.y,
                     rising_z_ ? node.hi.z : node.lo.z};
    return {largest_of(largest_of(std::fma(first.x, inverse_.x, enter_.x), std::fma(first.y, inverse_.y, enter_.y)),
                       largest_of(std::fma(first.z, inverse_.z, enter_.z), t_min_)),
            least_of(least_of(std::fma(last.x, inverse_.x, leave_.x), std::fma(last.y, inverse_.y, leave_.y)),
                     least_of(std::fma(last.z, inverse_.z, leave_.z), t_limit))};
  }

 private:
  Vec3f inverse_, enter_, leave_;
  float t_min_;
  bool rising_x_, rising_y_, rising_z_;
};

}  // namespace kd
