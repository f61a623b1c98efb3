// Average: the sum of a pixel's samples becomes their mean. Samples lie as the reconstruction filter has them
// (core/sampling.h), so all weigh the same.
#pragma once

#include "render/view.h"

namespace kd::render {

struct Average {
  static constexpr const char* kName = "average";
  FrameView frame;

  KD_HD uint32_t operator()(uint32_t pixel) const {
    const auto count = static_cast<float>(frame.samples);  // divided by, not multiplied: full coverage is 1
    const Pixel sum = frame.colour[pixel];
    frame.colour[pixel] = {{sum.colour.x / count, sum.colour.y / count, sum.colour.z / count}, sum.alpha / count};
    return 0;
  }
};

}  // namespace kd::render
