// Ray generation: one primary ray a pixel, through its centre.
#pragma once

#include "core/ray.h"
#include "render/view.h"

namespace kd::render {

/// Distance up to which a ray looks.
constexpr double kFar = 1e300;

struct RayGeneration {
  static constexpr const char* kName = "ray generation";
  FrameView frame;

  KD_HD uint32_t operator()(uint32_t pixel) const {
    const CameraView& c = frame.camera;
    const uint32_t column = pixel % frame.width, row = pixel / frame.width;
    frame.directions[pixel] =
        normalised(c.corner + c.right * static_cast<double>(column) + c.down * static_cast<double>(row));
    return 1;
  }
};

KD_HD KD_INLINE Ray primary_ray(const FrameView& frame, uint32_t pixel) {
  return {frame.camera.position, frame.directions[pixel], 0, kFar};
}

}  // namespace kd::render
