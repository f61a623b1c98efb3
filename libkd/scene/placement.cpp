#include "scene/placement.h"

#include <cmath>
#include <numbers>

#include "scene/motion.h"

namespace kd::scene {

namespace {

/// The images of the unit axes (Rodrigues).
Frame rotation(Vec3d axis, double degrees) {
  const Vec3d k = normalised(axis);
  // Quarter turns are common, and should be exact.
  const double quarters = degrees / 90;
  const double angle = degrees * std::numbers::pi / 180;
  double s = std::sin(angle), c = std::cos(angle);
  if (quarters == std::nearbyint(quarters)) {
    s = std::nearbyint(s);
    c = std::nearbyint(c);
  }
  const auto turned = [&](Vec3d v) { return v * c + cross(k, v) * s + k * (dot(k, v) * (1 - c)); };
  return {{0, 0, 0}, turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1})};
}

struct FrameOf {
  double frame;
  Frame operator()(const BoxPlacement& placement) const { return placement.box; }
  Frame operator()(const FramePlacement& placement) const { return placement.frame; }
  Frame operator()(const TransformPlacement& placement) const {
    if (!placement.keys.empty()) return still(interpolated(placement, frame));
    return still(placement);
  }
  static Frame still(const TransformPlacement& t) {
    const Frame turn = t.rotate_degrees == 0 ? Frame{} : rotation(t.rotate_axis, t.rotate_degrees);
    return {t.translate, turn.x_axis * t.scale.x, turn.y_axis * t.scale.y, turn.z_axis * t.scale.z};
  }
};

}  // namespace

Frame placement_frame(const Placement& placement, double frame) { return std::visit(FrameOf{frame}, placement); }
Frame placement_frame(const CharacterPlacement& placement, double frame) {
  return std::visit(FrameOf{frame}, placement);
}

Frame unit_cube_frame(const Lattice& lattice) {
  const double unit = 1.0 / lattice_max(lattice.bits);
  return {{0, 0, 0}, {unit, 0, 0}, {0, unit, 0}, {0, 0, unit}};
}

}  // namespace kd::scene
