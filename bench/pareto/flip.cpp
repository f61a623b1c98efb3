#include "pareto/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sys/parallel.h"

namespace kd::bench {

namespace {

constexpr double kPi = std::numbers::pi;

/// One number a pixel.
struct Plane {
  int width = 0;
  int height = 0;
  std::vector<double> values;

  Plane(int w, int h) : width(w), height(h), values(static_cast<size_t>(w) * static_cast<size_t>(h)) {}
  double& at(int x, int y) { return values[index(x, y)]; }
  double at(int x, int y) const { return values[index(x, y)]; }

 private:
  size_t index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  }
};

using Planes = std::array<Plane, 3>;

template <class Body>
void for_each_row(int height, const Body& body) {
  parallel_ranges(static_cast<size_t>(height), 16, [&](size_t begin, size_t end) {
    for (size_t y = begin; y < end; ++y) body(static_cast<int>(y));
  });
}

// --- Colour spaces (section 4.1) -------------------------------------------------------------------------------------

double srgb_to_linear(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }

/// Linear RGB to XYZ and back, for the primaries of sRGB (ITU-R BT.709) and the CIE's D65: the primaries' columns are
/// scaled so that (1, 1, 1) is the white.
class RgbSpace {
 public:
  RgbSpace() {
    const auto xyz = [](double x, double y) { return Vec3d{x / y, 1, (1 - x - y) / y}; };
    const Vec3d r = xyz(0.64, 0.33), g = xyz(0.30, 0.60), b = xyz(0.15, 0.06);
    white_ = xyz(0.31271, 0.32902);
    const double volume = dot(cross(r, g), b);
    red_ = r * (dot(cross(white_, g), b) / volume);
    green_ = g * (dot(cross(r, white_), b) / volume);
    blue_ = b * (dot(cross(r, g), white_) / volume);
    const double scaled = dot(cross(red_, green_), blue_);
    to_red_ = cross(green_, blue_) * (1 / scaled);
    to_green_ = cross(blue_, red_) * (1 / scaled);
    to_blue_ = cross(red_, green_) * (1 / scaled);
  }
  Vec3d white() const { return white_; }
  Vec3d to_xyz(Vec3d rgb) const { return red_ * rgb.x + green_ * rgb.y + blue_ * rgb.z; }
  Vec3d to_rgb(Vec3d xyz) const { return {dot(to_red_, xyz), dot(to_green_, xyz), dot(to_blue_, xyz)}; }
  /// As shares of the white's.
  Vec3d to_relative(Vec3d rgb) const {
    const Vec3d c = to_xyz(rgb);
    return {c.x / white_.x, c.y / white_.y, c.z / white_.z};
  }

 private:
  Vec3d white_, red_, green_, blue_, to_red_, to_green_, to_blue_;
};

/// YCxCz, CIELAB without its cube root: linear, so that filtering in it does not mix lightness with colour.
Vec3d to_ycxcz(const RgbSpace& space, Vec3d rgb) {
  const Vec3d c = space.to_relative(rgb);
  return {116 * c.y - 16, 500 * (c.x - c.y), 200 * (c.y - c.z)};
}
Vec3d from_ycxcz(const RgbSpace& space, Vec3d v) {
  const double y = (v.x + 16) / 116;
  return space.to_rgb(Vec3d{y + v.y / 500, y, y - v.z / 200} * space.white());
}

/// CIELAB with the Hunt effect: colours are the more colourful the lighter they are (section 4.1.2).
Vec3d to_hunt_lab(const RgbSpace& space, Vec3d rgb) {
  constexpr double kDelta = 6.0 / 29;
  const auto root = [](double t) {
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
  };
  const Vec3d c = space.to_relative(rgb);
  const double lightness = 116 * root(c.y) - 16;
  const double hunt = 0.01 * lightness;
  return {lightness, hunt * 500 * (root(c.x) - root(c.y)), hunt * 200 * (root(c.y) - root(c.z))};
}

/// Abasi et al.'s distance for large differences: lightness as in a city, colour as the crow flies (section 4.1.3).
double hyab(Vec3d a, Vec3d b) { return std::fabs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

// --- Filters
// ----------------------------------------------------------------------------------------------------------

/// Weights of the pixels from -radius to radius.
using Kernel = std::vector<double>;

template <class Weight>
Kernel sample(int radius, const Weight& weight) {
  Kernel kernel;
  for (int i = -radius; i <= radius; ++i) kernel.push_back(weight(i));
  return kernel;
}

/// The plane under across(x) * down(y); beyond its border it goes on as the border is.
Plane filtered(const Plane& in, const Kernel& across, const Kernel& down) {
  const int radius = static_cast<int>(across.size() / 2);
  Plane rows(in.width, in.height), out(in.width, in.height);
  for_each_row(in.height, [&](int y) {
    for (int x = 0; x < in.width; ++x) {
      double sum = 0;
      for (int i = -radius; i <= radius; ++i)
        sum += across[static_cast<size_t>(i + radius)] * in.at(std::clamp(x + i, 0, in.width - 1), y);
      rows.at(x, y) = sum;
    }
  });
  for_each_row(in.height, [&](int y) {
    for (int x = 0; x < in.width; ++x) {
      double sum = 0;
      for (int i = -radius; i <= radius; ++i)
        sum += down[static_cast<size_t>(i + radius)] * rows.at(x, std::clamp(y + i, 0, in.height - 1));
      out.at(x, y) = sum;
    }
  });
  return out;
}

/// A contrast sensitivity function as one or two Gaussians, in the space of pixels: a * sqrt(pi / b) *
/// exp(-pi^2 r^2 / b), r in degrees (section 4.1.1, table 1).
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr Sensitivity kAchromatic{1, 0.0047, 0, 1e-5}, kRedGreen{1, 0.0053, 0, 1e-5},
    kBlueYellow{34.1, 0.04, 13.5, 0.025};

/// What the eye keeps of the plane. The filter's weights sum to 1.
Plane seen(const Plane& in, const Sensitivity& s, double pixels_per_degree) {
  const double widest = std::max({kAchromatic.b1, kRedGreen.b1, kBlueYellow.b1, kBlueYellow.b2});
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(widest / (2 * kPi * kPi)) * pixels_per_degree));
  const auto gaussian = [&](double b) {
    return sample(radius, [&](int i) { return std::exp(-kPi * kPi * std::pow(i / pixels_per_degree, 2) / b); });
  };
  const auto share = [&](double a, double b, const Kernel& kernel) {
    double sum = 0;
    for (double weight : kernel) sum += weight;
    return a * std::sqrt(kPi / b) * sum * sum;
  };
  const auto scaled = [](Kernel kernel, double factor) {
    for (double& weight : kernel) weight *= factor;
    return kernel;
  };
  const Kernel first = gaussian(s.b1), second = gaussian(s.b2);
  const double total = share(s.a1, s.b1, first) + share(s.a2, s.b2, second);
  Plane out = filtered(in, scaled(first, s.a1 * std::sqrt(kPi / s.b1) / total), first);
  if (s.a2 == 0) return out;
  const Plane more = filtered(in, scaled(second, s.a2 * std::sqrt(kPi / s.b2) / total), second);
  for (size_t i = 0; i < out.values.size(); ++i) out.values[i] += more.values[i];
  return out;
}

/// Positive weights divided by their sum, negative ones by minus theirs; `across` times `down`, which is positive.
void normalise_signs(Kernel& across, Kernel& down) {
  double positive = 0, negative = 0, other = 0;
  for (double w : across) (w > 0 ? positive : negative) += w;
  for (double w : down) other += w;
  for (double& w : across) w /= w > 0 ? positive : -negative;
  for (double& w : down) w /= other;
}

/// Edges and points of a plane of luminance in [0, 1] (section 4.2): how steep and how curved it is under Gaussian
/// derivatives as wide as the eye's own edge detectors, 0.082 degrees.
struct Features {
  Plane edges, points;
};

Plane magnitude(const Plane& x, const Plane& y) {
  Plane out(x.width, x.height);
  for (size_t i = 0; i < out.values.size(); ++i) out.values[i] = std::hypot(x.values[i], y.values[i]);
  return out;
}

Features features(const Plane& luminance, double pixels_per_degree) {
  const double deviation = 0.5 * 0.082 * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * deviation));
  const auto gaussian = [&](int i) { return std::exp(-i * i / (2 * deviation * deviation)); };
  Kernel first = sample(radius, [&](int i) { return -i * gaussian(i); });
  Kernel second = sample(radius, [&](int i) { return (i * i / (deviation * deviation) - 1) * gaussian(i); });
  Kernel across_first = sample(radius, gaussian), across_second = across_first;
  normalise_signs(first, across_first);
  normalise_signs(second, across_second);
  return {magnitude(filtered(luminance, first, across_first), filtered(luminance, across_first, first)),
          magnitude(filtered(luminance, second, across_second), filtered(luminance, across_second, second))};
}

// --- One image, and two
// -----------------------------------------------------------------------------------------------

/// All that is compared of an image.
struct Impression {
  std::vector<Vec3d> colours;  // Hunt-adjusted CIELAB, as seen
  Features features;
};

Impression impression(const Picture& srgb, const RgbSpace& space, double pixels_per_degree) {
  const int width = static_cast<int>(srgb.width), height = static_cast<int>(srgb.height);
  const Plane empty(width, height);
  Planes channels{empty, empty, empty};
  Plane luminance = empty;
  for (size_t i = 0; i < srgb.pixels.size(); ++i) {
    const Vec3d p = vec_cast<double>(srgb.pixels[i]);
    const Vec3d v = to_ycxcz(space, {srgb_to_linear(p.x), srgb_to_linear(p.y), srgb_to_linear(p.z)});
    for (int c = 0; c < 3; ++c) channels[static_cast<size_t>(c)].values[i] = v[c];
    luminance.values[i] = (v.x + 16) / 116;
  }
  channels = {seen(channels[0], kAchromatic, pixels_per_degree), seen(channels[1], kRedGreen, pixels_per_degree),
              seen(channels[2], kBlueYellow, pixels_per_degree)};
  Impression out{std::vector<Vec3d>(srgb.pixels.size()), features(luminance, pixels_per_degree)};
  for (size_t i = 0; i < out.colours.size(); ++i) {
    const Vec3d rgb = from_ycxcz(space, {channels[0].values[i], channels[1].values[i], channels[2].values[i]});
    const auto shown = [](double c) { return std::clamp(c, 0.0, 1.0); };
    out.colours[i] = to_hunt_lab(space, {shown(rgb.x), shown(rgb.y), shown(rgb.z)});
  }
  return out;
}

/// Colour distances spread over [0, 1] (section 4.1.4): the power 0.7 first, and what is then below 0.4 of the largest
/// distance that sRGB has, that of green and blue, takes 0.95 of the interval.
class ColourDifference {
 public:
  explicit ColourDifference(const RgbSpace& space)
      : largest_(std::pow(hyab(to_hunt_lab(space, {0, 1, 0}), to_hunt_lab(space, {0, 0, 1})), kPower)) {}

  double operator()(Vec3d a, Vec3d b) const {
    const double distance = std::pow(hyab(a, b), kPower), knee = kKnee * largest_;
    if (distance < knee) return kBelowKnee / knee * distance;
    return kBelowKnee + (distance - knee) / (largest_ - knee) * (1 - kBelowKnee);
  }

 private:
  static constexpr double kPower = 0.7, kKnee = 0.4, kBelowKnee = 0.95;
  double largest_;
};

/// Section 4.2.
double feature_difference(const Features& a, const Features& b, size_t i) {
  const double edges = std::fabs(a.edges.values[i] - b.edges.values[i]);
  const double points = std::fabs(a.points.values[i] - b.points.values[i]);
  return std::sqrt(std::max(edges, points) / std::numbers::sqrt2);
}

}  // namespace

std::vector<float> flip_map(const Picture& reference, const Picture& test, double pixels_per_degree) {
  const RgbSpace space;
  const ColourDifference colour_difference(space);
  const Impression a = impression(reference, space, pixels_per_degree);
  const Impression b = impression(test, space, pixels_per_degree);
  std::vector<float> map(reference.pixels.size());
  for (size_t i = 0; i < map.size(); ++i) {
    const double colours = colour_difference(a.colours[i], b.colours[i]);
    map[i] = static_cast<float>(std::pow(colours, 1 - feature_difference(a.features, b.features, i)));  // section 4.3
  }
  return map;
}

double flip(const Picture& reference, const Picture& test, double pixels_per_degree) {
  double sum = 0;
  for (float difference : flip_map(reference, test, pixels_per_degree)) sum += static_cast<double>(difference);
  return sum / static_cast<double>(reference.pixels.size());
}

}  // namespace kd::bench
