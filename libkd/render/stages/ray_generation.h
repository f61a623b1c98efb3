// Ray generation: a sample's primary ray; of a pixel's only sample, through its centre.
//
// A function, not a launch of its own: the stages that want a pixel's ray compute it again, which takes less time than
// to write and read 24 bytes a pixel.
#pragma once

#include "core/ray.h"
#include "core/sampling.h"
#include "render/view.h"

namespace kd::render {

/// Distance up to which a ray looks.
constexpr double kFar = 1e300;

/// Of length 1.
KD_HD KD_INLINE Vec3d primary_direction(const FrameView& frame, uint32_t pixel) {
  const CameraView& c = frame.camera;
  const uint32_t column = frame.first_column + pixel % frame.width;
  const uint32_t row = frame.first_row + pixel / frame.width;
  SampleOffset offset{0, 0};
  if (frame.samples > 1) offset = sample_offset(column, row, frame.sample);
  return normalised(c.corner + c.right * (column + offset.x) + c.down * (row + offset.y));
}

KD_HD KD_INLINE Ray primary_ray(const FrameView& frame, uint32_t pixel) {
  return {frame.camera.position, primary_direction(frame, pixel), 0, kFar};
}

}  // namespace kd::render
