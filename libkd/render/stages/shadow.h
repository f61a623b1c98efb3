// Shadow: whether a light reaches a surface. A light behind the surface is not asked; a ray ends at the first occluder.
#pragma once

#include "render/stages/object_intersection.h"
#include "render/stages/surface.h"
#include "render/view.h"

namespace kd::render {

KD_HD KD_INLINE bool faces(const Surface& surface, const ToLight& way) {
  return dot(surface.geometric, way.direction) > 0 && dot(surface.shading, way.direction) > 0;
}

/// For a surface that faces the light.
template <class Instances>
KD_HD KD_INLINE bool is_lit(const SceneView& scene, const SurfaceHit& hit, Vec3d shadow_origin, const ToLight& way) {
  return !any_hit<Instances>(scene, {shadow_origin, way.direction, 0, way.distance}, {hit.instance, hit.triangle});
}

}  // namespace kd::render
