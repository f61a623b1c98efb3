// Shadow: whether a light reaches a surface. A light behind the surface is not asked; a ray ends at the first occluder.
#pragma once

#include "render/stages/object_intersection.h"
#include "render/stages/surface.h"
#include "render/view.h"

namespace kd::render {

KD_HD KD_INLINE bool faces(const Surface& surface, const ToLight& way) {
  return dot(surface.geometric, way.direction) > 0 && dot(surface.shading, way.direction) > 0;
}

/// Of a surface that faces the light: any_hit says whether it lies in shadow.
KD_HD KD_INLINE Ray shadow_ray(const Surface& surface, const ToLight& way) {
  return {surface.shadow_origin, way.direction, 0, way.distance};
}

}  // namespace kd::render
