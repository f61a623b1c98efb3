// Frames: a point and three axes. A frame places an object in a scene (the paper's scene-space box); any
// invertible one is legal, mirrored and sheared ones included.
#pragma once

#include <cmath>

#include "core/vec.h"

namespace kd {

/// p -> point + p.x * x_axis + p.y * y_axis + p.z * z_axis.
struct Frame {
  Vec3d point{0, 0, 0};
  Vec3d x_axis{1, 0, 0};
  Vec3d y_axis{0, 1, 0};
  Vec3d z_axis{0, 0, 1};

  KD_HD KD_INLINE Vec3d apply_vector(Vec3d v) const { return x_axis * v.x + y_axis * v.y + z_axis * v.z; }
  KD_HD KD_INLINE Vec3d apply_point(Vec3d p) const { return point + apply_vector(p); }
};

/// The way back: p -> rows * (p - point). The frame's point is subtracted first, so an object far from the scene's
/// origin loses nothing but what the coordinates of p themselves have lost.
struct InverseFrame {
  Vec3d point{0, 0, 0};
  Vec3d x_row{1, 0, 0};
  Vec3d y_row{0, 1, 0};
  Vec3d z_row{0, 0, 1};

  /// Of one vector or point, or of a packet's (core/packet.h).
  template <class T = double>
  KD_HD KD_INLINE Vec3<T> apply_vector(Vec3<T> v) const {
    return {fused_dot(vec_cast<T>(x_row), v), fused_dot(vec_cast<T>(y_row), v), fused_dot(vec_cast<T>(z_row), v)};
  }
  template <class T = double>
  KD_HD KD_INLINE Vec3<T> apply_point(Vec3<T> p) const {
    return apply_vector(p - vec_cast<T>(point));
  }
  /// Takes a normal of the framed space back out: the inverse transpose of the frame's axes.
  KD_HD KD_INLINE Vec3d normal_to_outer(Vec3d n) const { return x_row * n.x + y_row * n.y + z_row * n.z; }
};

/// outer after inner.
inline Frame compose(const Frame& outer, const Frame& inner) {
  return {outer.apply_point(inner.point), outer.apply_vector(inner.x_axis), outer.apply_vector(inner.y_axis),
          outer.apply_vector(inner.z_axis)};
}

/// Below this ratio of the axes' volume to the product of their lengths a frame counts as singular: its axes lie in a
/// plane to within 1e-9 of their lengths, and positions taken back through it would keep fewer than 7 digits.
constexpr double kSingularVolume = 1e-9;

/// Volume of the axes over the product of their lengths: 1 for orthogonal axes of any lengths, 0 for a singular
/// frame, negative for a mirrored one. NaN where an axis is zero or not finite.
inline double relative_volume(const Frame& f) {
  return dot(cross(normalised(f.x_axis), normalised(f.y_axis)), normalised(f.z_axis));
}

inline bool is_singular(const Frame& f) {
  const auto usable = [](Vec3d axis) { return is_finite(axis) && dot(normalised(axis), normalised(axis)) > 0.5; };
  if (!is_finite(f.point) || !usable(f.x_axis) || !usable(f.y_axis) || !usable(f.z_axis)) return true;
  return !(std::fabs(relative_volume(f)) > kSingularVolume);
}

/// The inverse of a frame that is not singular, by Cramer's rule on axes scaled to length 1: axis ratios of 10^6 and
/// scales of 10^+-12 cost no accuracy.
inline InverseFrame invert(const Frame& f) {
  const auto scale = [](Vec3d axis) { return max_of(std::fabs(axis.x), std::fabs(axis.y), std::fabs(axis.z)); };
  const double sx = scale(f.x_axis), sy = scale(f.y_axis), sz = scale(f.z_axis);
  const Vec3d a{f.x_axis.x / sx, f.x_axis.y / sx, f.x_axis.z / sx};
  const Vec3d b{f.y_axis.x / sy, f.y_axis.y / sy, f.y_axis.z / sy};
  const Vec3d c{f.z_axis.x / sz, f.z_axis.y / sz, f.z_axis.z / sz};
  const double volume = dot(cross(a, b), c);
  return {f.point, cross(b, c) * (1 / volume / sx), cross(c, a) * (1 / volume / sy), cross(a, b) * (1 / volume / sz)};
}

}  // namespace kd
