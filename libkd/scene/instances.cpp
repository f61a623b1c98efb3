#include "scene/instances.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

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

/// The placement as a frame of the space it is written in: the unit cube for a box, else model space.
Frame placement_frame(const Placement& placement) {
  if (const auto* box = std::get_if<BoxPlacement>(&placement)) return box->box;
  if (const auto* frame = std::get_if<FramePlacement>(&placement)) return frame->frame;
  const auto& t = std::get<TransformPlacement>(placement);
  const Frame turn = rotation(t);
  return {t.translate, turn.x_axis * t.scale.x, turn.y_axis * t.scale.y, turn.z_axis * t.scale.z};
}

/// Lattice space to the space the placement is written in.
Frame lattice_frame(const Placement& placement, const Lattice& lattice) {
  if (!std::holds_alternative<BoxPlacement>(placement)) return lattice.frame();
  const double unit = 1.0 / lattice_max(lattice.bits);
  return {{0, 0, 0}, {unit, 0, 0}, {0, unit, 0}, {0, 0, unit}};
}

Box3d placed_box(const Frame& lattice_to_scene, const Lattice& lattice) {
  const Box3u cube = lattice.cube();
  Box3d box;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3u q{corner & 1 ? cube.hi.x : 0, corner & 2 ? cube.hi.y : 0, corner & 4 ? cube.hi.z : 0};
    box.extend(lattice_to_scene.apply_point(vec_cast<double>(q)));
  }
  return box;
}

Error placement_error(const Scene& scene, const Part& part, const char* what) {
  const std::string name = part.name.empty() ? fmt::format("a part of '{}'", scene.objects[part.object].name)
                                             : fmt::format("part '{}'", part.name);
  return {ErrorClass::scene, fmt::format("{}:{}", scene.path, part.line), fmt::format("{}: {}", name, what)};
}

}  // namespace

std::vector<bool> used_objects(const Scene& scene) {
  std::vector<bool> used(scene.objects.size(), false);
  for (const Character& character : scene.characters) {
    for (const Part& part : character.parts) used[part.object] = true;
  }
  return used;
}

Result<std::vector<Instance>> place_instances(const Scene& scene, std::span<const Lattice> lattices) {
  std::vector<Instance> instances;
  for (const Character& character : scene.characters) {
    for (const Part& part : character.parts) {
      const Frame placement = placement_frame(part.placement);
      if (is_singular(placement)) {
        return placement_error(scene, part,
                               "the placement is singular: its axes must be finite, not zero, and not lie in a plane");
      }
      const Lattice& lattice = lattices[part.object];
      Instance instance;
      instance.object = part.object;
      instance.lattice_to_scene = compose(placement, lattice_frame(part.placement, lattice));
      instance.scene_to_lattice = invert(instance.lattice_to_scene);
      instance.box_scene = placed_box(instance.lattice_to_scene, lattice);
      instance.material = part.material;
      const InverseFrame& back = instance.scene_to_lattice;
      if (!is_finite(instance.box_scene.lo) || !is_finite(instance.box_scene.hi) || !is_finite(back.x_row) ||
          !is_finite(back.y_row) || !is_finite(back.z_row)) {
        return placement_error(scene, part,
                               "the placement leaves the range of double precision: bring it nearer or scale it less");
      }
      instances.push_back(instance);
    }
  }
  return instances;
}

}  // namespace kd::scene
