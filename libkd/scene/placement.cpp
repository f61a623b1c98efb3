#include "scene/placement.h"

#include <cmath>
#include <numbers>

namespace kd::scene {

namespace {

/// The rotation that `placement` asks for, as the images of the unit axes (Rodrigues).
Frame rotation(const TransformPlacement& placement) {
  const Vec3d k = normalised(placement.rotate_axis);
  // Quarter turns are common, and should be exact.
  const double quarters = placement.rotate_degrees / 90;
  const double angle = placement.rotate_degrees * std::numbers::pi / 180;
  double s = std::sin(angle), c = std::cos(angle);
  if (quarters == std::nearbyint(quarters)) {
    s = std::nearbyint(s);
    c = std::nearbyint(c);
  }
  const auto turned = [&](Vec3d v) { return v * c + cross(k, v) * s + k * (dot(k, v) * (1 - c)); };
  return {{0, 0, 0}, turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1})};
}

struct FrameOf {
  Frame operator()(const BoxPlacement& placement) const { return placement.box; }
  Frame operator()(const FramePlacement& placement) const { return placement.frame; }
  Frame operator()(const TransformPlacement& placement) const {
    const Frame turn = placement.rotate_degrees == 0 ? Frame{} : rotation(placement);
    const Vec3d scale = placement.scale;
    return {placement.translate, turn.x_axis * scale.x, turn.y_axis * scale.y, turn.z_axis * scale.z};
  }
};

}  // namespace

Frame placement_frame(const Placement& placement) { return std::visit(FrameOf{}, placement); }
Frame placement_frame(const CharacterPlacement& placement) { return std::visit(FrameOf{}, placement); }

Frame unit_cube_frame(const Lattice& lattice) {
  const double unit = 1.0 / lattice_max(lattice.bits);
  return {{0, 0, 0}, {unit, 0, 0}, {0, unit, 0}, {0, 0, unit}};
}

}  // namespace kd::scene
