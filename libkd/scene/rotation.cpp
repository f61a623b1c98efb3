#include "scene/rotation.h"

#include <cmath>
#include <numbers>
#include <optional>

namespace kd::scene {

namespace {

constexpr double kRadians = std::numbers::pi / 180;
/// Below this sine of the angle between them two axes are one.
constexpr double kSameAxisSine = 1e-9;

/// Of length 1: a rotation by twice the angle whose cosine is w.
struct Quaternion {
  double w = 1;
  Vec3d v;
};

Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.w - dot(a.v, b.v), b.v * a.w + a.v * b.w + cross(a.v, b.v)};
}

Quaternion conjugate(const Quaternion& q) { return {q.w, -q.v}; }

/// Of a rotation vector: along the axis, as long as the angle in radians.
Quaternion exponential(Vec3d turn) {
  const double angle = length(turn);
  return {std::cos(angle / 2), normalised(turn) * std::sin(angle / 2)};
}

/// The rotation vector of the short way, at most pi long.
Vec3d logarithm(const Quaternion& q) {
  const Vec3d v = q.w < 0 ? -q.v : q.v;
  return normalised(v) * (2 * std::atan2(length(v), std::fabs(q.w)));
}

/// Of all rotation vectors of q, which are whole turns apart, the one nearest to `expected`.
Vec3d logarithm_near(const Quaternion& q, Vec3d expected) {
  const Vec3d turn = logarithm(q);
  const double angle = length(turn), full = 2 * std::numbers::pi;
  const Vec3d axis = angle > 1e-12 ? normalised(turn) : normalised(expected);
  return axis * (angle + full * std::nearbyint((dot(expected, axis) - angle) / full));
}

Vec3d rotation_vector(const Rotation& r) { return normalised(r.axis) * (r.degrees * kRadians); }
Quaternion quaternion(const Rotation& r) { return exponential(rotation_vector(r)); }

Rotation to_rotation(const Quaternion& q) {
  const double half_sine = length(q.v);
  if (half_sine == 0) return {};
  return {normalised(q.v), 2 * std::atan2(half_sine, q.w) / kRadians};
}

/// The rotation's degrees about `axis`, of length 1, if it is about that.
std::optional<double> degrees_about(Vec3d axis, const Rotation& r) {
  if (r.degrees == 0) return 0;
  const Vec3d own = normalised(r.axis);
  if (length(cross(axis, own)) > kSameAxisSine) return std::nullopt;
  return dot(axis, own) < 0 ? -r.degrees : r.degrees;
}

Vec3d common_axis(const Rotation& a, const Rotation& b) { return normalised(a.degrees != 0 ? a.axis : b.axis); }

/// The rotation vector that takes a to b, in the space that both turn.
Vec3d turn_between(const Rotation& a, const Rotation& b) {
  const Vec3d axis = common_axis(a, b);
  const auto from = degrees_about(axis, a), to = degrees_about(axis, b);
  if (from && to) return axis * ((*to - *from) * kRadians);
  return logarithm(conjugate(quaternion(a)) * quaternion(b));
}

/// The segment in degrees, if all its keys turn about `axis`; without neighbours if those do not matter.
std::optional<KeySegment<double>> in_degrees(const KeySegment<Rotation>& s, Vec3d axis, bool with_neighbours) {
  bool all = true;
  const auto degrees = [&](const Rotation& r) {
    const auto about = degrees_about(axis, r);
    all = all && about;
    return about.value_or(0);
  };
  KeySegment<Rotation> wanted = s;
  if (!with_neighbours) wanted.before = wanted.after = std::nullopt;
  const KeySegment<double> mapped = wanted.mapped<double>(degrees);
  return all ? std::optional(mapped) : std::nullopt;
}

/// Any axis that turns: the one that all must have.
Vec3d first_axis(const KeySegment<Rotation>& s) {
  if (s.from.value.degrees != 0 || s.to.value.degrees != 0) return common_axis(s.from.value, s.to.value);
  return normalised(s.before && s.before->value.degrees != 0 ? s.before->value.axis
                    : s.after && s.after->value.degrees != 0 ? s.after->value.axis
                                                             : s.from.value.axis);
}

Quaternion smooth_quaternion(const KeySegment<Rotation>& s, Vec3d turn) {
  // A third of the way that each end's angular velocity goes: inner control points of a Bezier curve.
  const double third = s.duration() / 3;
  Vec3d first, last;
  if (s.before) {
    first = (turn_between(s.before->value, s.from.value) + turn) * (third / (s.to.frame - s.before->frame));
  }
  if (s.after) {
    last = (turn + turn_between(s.to.value, s.after->value)) * (third / (s.after->frame - s.from.frame));
  }
  const Vec3d middle =
      logarithm_near(exponential(-first) * exponential(turn) * exponential(-last), turn - first - last);
  const double u = s.share(), rest = 1 - u;
  return quaternion(s.from.value) * exponential(first * (1 - rest * rest * rest)) *
         exponential(middle * (u * u * (3 - 2 * u))) * exponential(last * (u * u * u));
}

}  // namespace

Rotation interpolate(const KeySegment<Rotation>& s, Interpolation interpolation) {
  const bool smooth = interpolation == Interpolation::smooth;
  const Vec3d axis = first_axis(s);
  if (const auto degrees = in_degrees(s, axis, smooth)) return {axis, interpolate(*degrees, interpolation)};
  const Vec3d turn = turn_between(s.from.value, s.to.value);
  if (smooth) return to_rotation(smooth_quaternion(s, turn));
  return to_rotation(quaternion(s.from.value) * exponential(turn * s.share()));
}

}  // namespace kd::scene
