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
    const Vec3f c = frame.colour[pixel].colour;
    uint8_t* out = frame.preview + 3 * static_cast<uint64_t>(pixel);
    for (int channel = 0; channel < 3; ++channel) {
      const double clamped = min_of(max_of(static_cast<double>(c[channel]), 0.0), 1.0);
      out[channel] = static_cast<uint8_t>(std::floor(exact_pow(clamped, frame.inverse_gamma) * 255 + 0.5));
    }
    return 0;
  }
};

/// The film itself, unclamped; only when asked for. Runs after the preview.
struct GammaFilm {
  static constexpr const char* kName = "gamma";
  FrameView frame;

  KD_HD uint32_t operator()(uint32_t pixel) const {
    Pixel out = frame.colour[pixel];
    const auto shown = [&](float c) {
      return static_cast<float>(exact_pow(max_of(static_cast<double>(c), 0.0), frame.inverse_gamma));
    };
    out.colour = {shown(out.colour.x), shown(out.colour.y), shown(out.colour.z)};
    frame.colour[pixel] = out;
    return 0;
  }
};

}  // namespace kd::render
