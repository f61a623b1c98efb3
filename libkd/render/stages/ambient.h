// Ambient: what a pixel has before any light reaches it, the surface's emission included; the background where its ray
// met nothing.
#pragma once

#include "render/stages/surface.h"
#include "render/view.h"

namespace kd::render {

KD_HD KD_INLINE Pixel ambient_of(const SceneView& scene, const SurfaceHit& hit) {
  if (hit.instance == kNone) return {scene.background, 0};
  const Material material = material_at(scene, hit);
  return {scene.ambient * material.ambient + material.emission, 1};
}

/// What a sample begins with: its ambient colour, added to the pixel's samples before it.
KD_HD KD_INLINE Pixel begin_sample(const FrameView& frame, uint32_t pixel, const SurfaceHit& hit) {
  Pixel out = ambient_of(frame.scene, hit);
  if (frame.sample > 0) {
    const Pixel before = frame.colour[pixel];
    out = {before.colour + out.colour, before.alpha + out.alpha};
  }
  return out;
}

/// The stage where no light follows; else the first light's colour stage begins with it.
struct Ambient {
  static constexpr const char* kName = "ambient";
  FrameView frame;

  KD_HD uint32_t operator()(uint32_t pixel) const {
    frame.colour[pixel] = begin_sample(frame, pixel, frame.hits[pixel]);
    return 0;
  }
};

}  // namespace kd::render
