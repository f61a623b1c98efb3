// Ambient: what a pixel has before any light reaches it; the background where its ray met nothing.
#pragma once

#include "render/stages/surface.h"
#include "render/view.h"

namespace kd::render {

struct Ambient {
  static constexpr const char* kName = "ambient";
  FrameView frame;

  KD_HD uint32_t operator()(uint32_t pixel) const {
    const SurfaceHit& hit = frame.hits[pixel];
    const bool met = hit.instance != kNone;
    const Vec3f c = met ? frame.scene.ambient * material_at(frame.scene, hit).ambient : frame.scene.background;
    float* out = frame.colour + 4 * static_cast<uint64_t>(pixel);
    out[0] = c.x;
    out[1] = c.y;
    out[2] = c.z;
    out[3] = met ? 1.0f : 0.0f;
    return 0;
  }
};

}  // namespace kd::render
