// Pictures that are compared: linear RGB, rows from the top, and what of them a display shows.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace kd::bench {

struct Picture {
  uint32_t width = 0;
  uint32_t height = 0;
  std::vector<Vec3f> pixels;  // width * height; y * width + x
};

/// Clamped to [0, 1], through the sRGB transfer function (IEC 61966-2-1), in steps of 1/255.
Picture to_srgb8(const Picture& linear);

/// Root of the mean squared difference over pixels and channels. Pictures of one size, not empty.
double rmse(const Picture& a, const Picture& b);

}  // namespace kd::bench
