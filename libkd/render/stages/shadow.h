// Shadow: whether one light reaches a pixel's surface. A light behind the surface is not asked; a ray ends at the first
// occluder. Returns how many rays were cast.
#pragma once

#include "render/stages/object_intersection.h"
#include "render/stages/surface.h"
#include "render/view.h"

namespace kd::render {

struct Shadow {
  static constexpr const char* kName = "shadow";
  FrameView frame;
  uint32_t light = 0;

  KD_HD uint32_t operator()(uint32_t pixel) const {
    const SurfaceHit& hit = frame.hits[pixel];
    frame.visibility[pixel] = kNotAsked;
    if (hit.instance == kNone) return 0;
    const Vec3d direction = frame.directions[pixel];
    const Surface surface = surface_at(frame.scene, hit, direction);
    const ToLight way = to_light(frame.scene.lights[light], surface.shadow_origin, kFar);
    if (!(dot(surface.geometric, way.direction) > 0) || !(dot(surface.shading, way.direction) > 0)) return 0;
    const Ray ray{surface.shadow_origin, way.direction, 0, way.distance};
    frame.visibility[pixel] = any_hit(frame.scene, ray, {hit.instance, hit.triangle}) ? kOccluded : kLit;
    return 1;
  }
};

}  // namespace kd::render
