// The film: what a render returns. Row 0 is at the top, pixels follow each other from left to right.
#pragma once

#include <cstdint>
#include <vector>

#include "image/channels.h"

namespace kd::image {

struct AovBuffer {
  Aov aov = Aov::depth;
  std::vector<uint32_t> words;  // the row's components, interleaved: components x width x height; floats as their bits
};

struct Film {
  uint32_t width = 0;
  uint32_t height = 0;
  std::vector<float> colour;  // RGBA, interleaved, scene-linear: 4 x width x height
  std::vector<AovBuffer> aovs;
};

}  // namespace kd::image
