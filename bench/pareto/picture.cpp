#include "pareto/picture.h"

#include <algorithm>
#include <cmath>

namespace kd::bench {

namespace {

float to_srgb8(float linear) {
  const double c = std::clamp(static_cast<double>(linear), 0.0, 1.0);
  const double encoded = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
  return static_cast<float>(std::nearbyint(encoded * 255) / 255);
}

}  // namespace

Picture to_srgb8(const Picture& linear) {
  Picture out = linear;
  for (Vec3f& p : out.pixels) p = {to_srgb8(p.x), to_srgb8(p.y), to_srgb8(p.z)};
  return out;
}

double rmse(const Picture& a, const Picture& b) {
  double sum = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    const Vec3d difference = vec_cast<double>(a.pixels[i]) - vec_cast<double>(b.pixels[i]);
    sum += dot(difference, difference);
  }
  return std::sqrt(sum / (3 * static_cast<double>(a.pixels.size())));
}

}  // namespace kd::bench
