// Colour: what one light adds to a pixel it reaches, after Phong ("Illumination for computer generated pictures", CACM
// 1975): kd (N.L) + ks (R.V)^n, times the light's colour and the share of it that arrives.
#pragma once

#include "core/power.h"
#include "render/stages/ambient.h"
#include "render/stages/ray_generation.h"
#include "render/stages/shadow.h"
#include "render/stages/surface.h"
#include "render/view.h"

namespace kd::render {

/// What a surface that faces the light sends of it against `direction`.
KD_HD inline Vec3f reflected(const LightView& light, const Surface& surface, const Material& material,
                             Vec3d to_light_direction, Vec3d direction) {
  const double cosine = dot(surface.shading, to_light_direction);
  const Vec3d mirrored = surface.shading * (2 * cosine) - to_light_direction;
  const double toward_viewer = max_of(-dot(mirrored, direction), 0.0);
  const auto diffuse = static_cast<float>(cosine);
  const bool glossy = material.specular.x > 0 || material.specular.y > 0 || material.specular.z > 0;
  const float specular = glossy ? static_cast<float>(exact_pow(toward_viewer, material.shininess)) : 0.0f;
  return light.colour * (material.diffuse * diffuse + material.specular * specular);
}

/// Shadow and colour of one light in one launch: apart, each would read the hits and find the surface again. The first
/// light begins with the ambient colour. Returns how many shadow rays were cast.
template <class Instances>
struct Lighting {
  static constexpr const char* kName = "shadow, colour";
  FrameView frame;
  uint32_t light = 0;

  /// Calls trace(shadow ray, the colour that is added if it meets nothing) where the light may add something; whether
  /// it did.
  template <class Trace>
  KD_HD KD_INLINE bool ask(uint32_t pixel, const SurfaceHit& hit, const Trace& trace) const {
    if (hit.instance == kNone) return false;
    const LightView& source = frame.scene.lights[light];
    const Vec3d direction = primary_direction(frame, pixel);
    const Surface surface = surface_at(frame.scene, hit, direction);
    const ToLight way = to_light(source, surface.shadow_origin, kFar);
    const float share = arriving(source, way);
    const bool asked = share > 0 && faces(surface, way);
    if (asked) {
      // Before the ray is traced, so that nothing else of the surface is kept meanwhile.
      const Material material = material_at(frame.scene, hit);
      trace(shadow_ray(surface, way), reflected(source, surface, material, way.direction, direction) * share);
    }
    return asked;
  }

  KD_HD KD_INLINE void add(uint32_t pixel, const SurfaceHit& hit, bool lit, Vec3f added) const {
    const bool first = light == 0;
    if (!first && !lit) return;
    Pixel out = first ? begin_sample(frame, pixel, hit) : frame.colour[pixel];
    if (lit) out.colour = out.colour + added;
    frame.colour[pixel] = out;
  }

  KD_HD uint32_t operator()(uint32_t pixel) const {
    const SurfaceHit hit = frame.hits[pixel];
    bool lit = false;
    Vec3f added{0, 0, 0};
    const bool asked = ask(pixel, hit, [&](const Ray& ray, Vec3f colour) {
      added = colour;
      lit = !any_hit<Instances>(frame.scene, ray, {hit.instance, hit.triangle});
    });
    add(pixel, hit, lit, added);
    return asked;
  }
};

}  // namespace kd::render
