// Colour: what one light adds to a pixel it reaches, after Phong ("Illumination for computer generated pictures", CACM
// 1975): kd (N.L) + ks (R.V)^n, times the light's colour. Lights do not fall off with distance, as in the paper.
#pragma once

#include "core/power.h"
#include "render/stages/surface.h"
#include "render/view.h"

namespace kd::render {

struct Colour {
  static constexpr const char* kName = "colour";
  FrameView frame;
  uint32_t light = 0;

  KD_HD uint32_t operator()(uint32_t pixel) const {
    if (frame.visibility[pixel] != kLit) return 0;
    const SurfaceHit& hit = frame.hits[pixel];
    const Vec3d direction = frame.directions[pixel];
    const LightView& source = frame.scene.lights[light];
    const Surface surface = surface_at(frame.scene, hit, direction);
    const Material material = material_at(frame.scene, hit);

    const Vec3d to_source = to_light(source, surface.shadow_origin, 0).direction;
    const double cosine = dot(surface.shading, to_source);
    const Vec3d mirrored = surface.shading * (2 * cosine) - to_source;
    const double toward_viewer = max_of(-dot(mirrored, direction), 0.0);
    const auto diffuse = static_cast<float>(cosine);
    const bool glossy = material.specular.x > 0 || material.specular.y > 0 || material.specular.z > 0;
    const float specular = glossy ? static_cast<float>(exact_pow(toward_viewer, material.shininess)) : 0.0f;

    const Vec3f added = source.colour * (material.diffuse * diffuse + material.specular * specular);
    float* out = frame.colour + 4 * static_cast<uint64_t>(pixel);
    out[0] += added.x;
    out[1] += added.y;
    out[2] += added.z;
    return 0;
  }
};

}  // namespace kd::render
