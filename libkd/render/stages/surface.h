// The surface at a hit: where it is, which way it faces, what it is made of. Shared by the stages after intersection.
#pragma once

#include "render/view.h"

namespace kd::render {

/// How far above a surface its shadow rays start, in grid steps of 2^-24 of the object's cube, along the surface's
/// lattice normal. Snapping a ray moves it sideways by less than one such step (core/lattice_ray.h), so a ray that
/// starts two above a plane stays on its side, and at up to 21 bits two are a quarter of a lattice step: less than any
/// gap there can be.
constexpr double kShadowLift = 2;

struct Surface {
  Vec3d position;       // scene space
  Vec3d shadow_origin;  // scene space: the position, lifted towards the viewer
  Vec3d geometric;      // normals, scene space, length 1, facing the viewer
  Vec3d shading;
};

namespace detail {

KD_HD KD_INLINE Vec3d facing(Vec3d normal, Vec3d direction) { return dot(normal, direction) > 0 ? -normal : normal; }

/// The interpolated vertex normal in lattice space, of any length; zero where a corner has none. A model-space normal
/// reaches the lattice by the steps: n_lattice = n_model * step.
KD_HD KD_INLINE Vec3d interpolated_normal(const ShadedObjectView& object, const SurfaceHit& hit) {
  const uint32_t* corner = object.normal_indices + 3 * static_cast<uint64_t>(hit.triangle);
  if (corner[0] == kNone || corner[1] == kNone || corner[2] == kNone) return {0, 0, 0};
  const Vec3d n_model = vec_cast<double>(object.normals[corner[0]]) * (1 - hit.u - hit.v) +
                        vec_cast<double>(object.normals[corner[1]]) * hit.u +
                        vec_cast<double>(object.normals[corner[2]]) * hit.v;
  return n_model * object.step;
}

}  // namespace detail

/// `direction`: of the ray that hit.
KD_HD inline Surface surface_at(const SceneView& scene, const SurfaceHit& hit, Vec3d direction) {
  const InstanceView& instance = scene.instances[hit.instance];
  const ShadedObjectView& object = scene.objects[instance.object];
  const TriangleVertices triangle = object.tree.triangle(hit.triangle);
  const Vec3d a = vec_cast<double>(triangle.a);
  const Vec3d ab = vec_cast<double>(triangle.b) - a, ac = vec_cast<double>(triangle.c) - a;
  const Vec3d p_lattice = a + ab * hit.u + ac * hit.v;  // on the plane, whatever rounding did to u and v
  const Vec3d n_lattice = normalised(cross(ab, ac));

  Surface s;
  s.position = instance.to_scene.apply_point(p_lattice);
  s.geometric = normalised(instance.to_lattice.normal_to_outer(n_lattice));
  const bool flipped = dot(s.geometric, direction) > 0;
  if (flipped) s.geometric = -s.geometric;
  const double grid = power_of_two(object.tree.bits - kMaxLatticeBits);
  s.shadow_origin =
      instance.to_scene.apply_point(p_lattice + n_lattice * (flipped ? -kShadowLift * grid : kShadowLift * grid));

  s.shading = s.geometric;
  if (object.normal_indices) {
    const Vec3d n = normalised(instance.to_lattice.normal_to_outer(detail::interpolated_normal(object, hit)));
    if (dot(n, n) > 0.5) s.shading = detail::facing(n, direction);
  }
  return s;
}

KD_HD inline Material material_at(const SceneView& scene, const SurfaceHit& hit) {
  const InstanceView& instance = scene.instances[hit.instance];
  if (instance.material != kNone) return scene.overrides[instance.material];
  const ShadedObjectView& object = scene.objects[instance.object];
  return object.material_ids ? object.materials[object.material_ids[hit.triangle]] : Material{};
}

/// The way from a surface to a light, length 1, and how far the light is.
struct ToLight {
  Vec3d direction;
  double distance;
};

/// How much of a light arrives that way, if nothing is in it (docs/scenes.md has the formulas).
KD_HD inline float arriving(const LightView& light, const ToLight& way) {
  if (light.is_even) return 1;
  double share = 1;
  if (light.inverse_square) share = 1 / (way.distance * way.distance);
  const double d = way.distance * light.inverse_reach;
  if (d >= 1) return 0;
  const double window = 1 - (d * d) * (d * d);
  share = share * (window * window);
  const double s = (-dot(light.axis, way.direction) - light.cos_outer) * light.inverse_width;
  if (s <= 0) return 0;
  if (s < 1) share = share * (s * s * (3 - 2 * s));
  return static_cast<float>(min_of(share, 1e30));  // no infinity, which black would make a NaN of
}

KD_HD KD_INLINE ToLight to_light(const LightView& light, Vec3d from, double far_away) {
  if (!light.is_point) return {light.vector, far_away};
  const Polar way = polar(light.vector - from);
  return {way.direction, way.length};
}

}  // namespace kd::render
