// Gamma: from scene-linear to what a display of that gamma wants: c^(1/gamma).
#pragma once

#include "core/power.h"
#include "render/view.h"

namespace kd::render {

/// The preview: 8 bits a channel, clamped to [0, 1], rounded.
struct GammaPreview {
  static constexpr const char* kName = "gamma";
  FrameView frame;

  KD_HD uint32_t operator()(uint32_t pixel) const {
    for (uint64_t channel = 0; channel < 3; ++channel) {
      const double c = frame.colour[4 * static_cast<uint64_t>(pixel) + channel];
      const double shown = exact_pow(min_of(max_of(c, 0.0), 1.0), frame.inverse_gamma);
      frame.preview[3 * static_cast<uint64_t>(pixel) + channel] = static_cast<uint8_t>(std::floor(shown * 255 + 0.5));
    }
    return 0;
  }
};

/// The film itself, unclamped; only when asked for. Runs after the preview.
struct GammaFilm {
  static constexpr const char* kName = "gamma";
  FrameView frame;

  KD_HD uint32_t operator()(uint32_t pixel) const {
    for (uint64_t channel = 0; channel < 3; ++channel) {
      float& c = frame.colour[4 * static_cast<uint64_t>(pixel) + channel];
      c = static_cast<float>(exact_pow(max_of(static_cast<double>(c), 0.0), frame.inverse_gamma));
    }
    return 0;
  }
};

}  // namespace kd::render
