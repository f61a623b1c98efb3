#include "image/heatmap.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kd::image {

namespace {

uint32_t visits_of(const AovBuffer& visits, size_t pixel) {
  return visits.words[2 * pixel] + visits.words[2 * pixel + 1];
}

/// Stops at equal distances; their lightness grows evenly, so that the picture reads without its colours too.
constexpr std::array<std::array<double, 3>, 6> kStops{
    {{0, 0, 4}, {66, 10, 104}, {147, 38, 103}, {221, 81, 58}, {252, 165, 10}, {252, 255, 164}}};

}  // namespace

uint32_t most_visits(const AovBuffer& visits) {
  uint32_t most = 1;
  for (size_t pixel = 0; 2 * pixel < visits.words.size(); ++pixel) most = std::max(most, visits_of(visits, pixel));
  return most;
}

std::vector<uint8_t> heatmap(const AovBuffer& visits, uint32_t most) {
  std::vector<uint8_t> rgb;
  rgb.reserve(visits.words.size() / 2 * 3);
  for (size_t pixel = 0; 2 * pixel < visits.words.size(); ++pixel) {
    const double share = std::min(1.0, static_cast<double>(visits_of(visits, pixel)) / most);
    const double at = share * (kStops.size() - 1);
    const auto below = std::min(static_cast<size_t>(at), kStops.size() - 2);
    for (size_t channel = 0; channel < 3; ++channel) {
      const double value =
          std::lerp(kStops[below][channel], kStops[below + 1][channel], at - static_cast<double>(below));
      rgb.push_back(static_cast<uint8_t>(std::lround(value)));
    }
  }
  return rgb;
}

}  // namespace kd::image
