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

/// A part of a picture, in pixels from the picture's top left.
struct Window {
  uint32_t column = 0;
  uint32_t row = 0;
  uint32_t width = 0;
  uint32_t height = 0;
};

struct Film {
  uint32_t width = 0;
  uint32_t height = 0;
  uint32_t column = 0;  // where the film lies in its picture
  uint32_t row = 0;
  uint32_t picture_width = 0;  // 0: the film is the picture
  uint32_t picture_height = 0;
  std::vector<float> colour;  // RGBA, interleaved, scene-linear: 4 x width x height
  std::vector<AovBuffer> aovs;
};

}  // namespace kd::image
