#include "surface.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace kd::bench {

namespace {

/// 32 bits for a lattice point of one octave of one field (the finalizer of MurmurHash3).
uint32_t scatter(uint32_t x, uint32_t z, uint32_t layer) {
  uint32_t h = x * 0x8da6b343u ^ z * 0xd8163841u ^ layer * 0xcb1ab31fu;
  h = (h ^ h >> 16) * 0x85ebca6bu;
  h = (h ^ h >> 13) * 0xc2b2ae35u;
  return h ^ h >> 16;
}

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

/// Value noise in [-1, 1] with cells of length 1.
double noise(double x, double z, uint32_t layer) {
  const double fx = std::floor(x), fz = std::floor(z);
  const auto ix = static_cast<uint32_t>(fx), iz = static_cast<uint32_t>(fz);
  const auto at = [&](uint32_t dx, uint32_t dz) { return scatter(ix + dx, iz + dz, layer) * 0x1p-31 - 1; };
  const double u = fade(x - fx), v = fade(z - fz);
  const double near = at(0, 0) + u * (at(1, 0) - at(0, 0)), far = at(0, 1) + u * (at(1, 1) - at(0, 1));
  return near + v * (far - near);
}

constexpr uint32_t kHeight = 0, kAlong = 64, kAcross = 128;  // the layers of three fields
constexpr double kCoarsest = 4;                              // cells along an edge of the surface
constexpr int kPushedOctaves = 4;                            // that move sideways; finer ones only rise

}  // namespace

Surface::Surface(uint64_t triangles)
    : triangles_(triangles),
      columns_(std::max<uint64_t>(1, static_cast<uint64_t>(std::sqrt(static_cast<double>(triangles / 2))))),
      octaves_(std::max(1, static_cast<int>(std::bit_width(columns_)) - 4)) {}

uint64_t Surface::vertex_count() const {
  const uint64_t quads = (triangles_ + 1) / 2, rows = (quads + columns_ - 1) / columns_;
  const uint64_t in_last_row = quads - (rows - 1) * columns_;
  return rows * (columns_ + 1) + in_last_row + 1;
}

Vec3f Surface::vertex(uint64_t i) const {
  const auto quads = static_cast<double>(columns_);
  const double x = static_cast<double>(i % (columns_ + 1)) / quads, z = static_cast<double>(i / (columns_ + 1)) / quads;
  double height = 0, along = 0, across = 0, cells = kCoarsest, size = 1 / kCoarsest;
  for (int octave = 0; octave < octaves_; ++octave, cells *= 2, size *= 0.5) {
    const auto layer = static_cast<uint32_t>(octave);
    const double ridge = 1 - std::fabs(noise(x * cells, z * cells, kHeight + layer));
    height += 0.7 * size * ridge * ridge;
    if (octave >= kPushedOctaves) continue;
    // Steeper than 1 in places: there the surface folds over itself.
    along += 0.3 * size * noise(x * cells, z * cells, kAlong + layer);
    across += 0.3 * size * noise(x * cells, z * cells, kAcross + layer);
  }
  return vec_cast<float>(Vec3d{x + along, height, z + across});
}

Surface::Corners Surface::triangle(uint64_t i) const {
  const uint64_t quad = i / 2, across = columns_ + 1;
  const auto corner = static_cast<int32_t>(quad / columns_ * across + quad % columns_);
  const auto below = static_cast<int32_t>(corner + static_cast<int32_t>(across));
  if (i % 2 == 0) return {corner, below, below + 1};
  return {corner, below + 1, corner + 1};
}

}  // namespace kd::bench
