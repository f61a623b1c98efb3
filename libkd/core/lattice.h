// The lattice: the fixed-point grid on which an object's vertices and split planes lie. The object's box, as tight as
// mesh/lattice_fit.h makes it, is the unit cube; a coordinate is an integer q in [0, 2^B - 1], B <= 24, and stands for
// the model coordinate origin + q * step, step = extent / (2^B - 1). With B <= 24 a coordinate, and a difference of
// two, is exact in float32.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/box.h"
#include "core/frame.h"
#include "core/vec.h"

namespace kd {

constexpr int kMinLatticeBits = 1;
constexpr int kMaxLatticeBits = 24;
constexpr int kDefaultLatticeBits = 21;  // 3 x 21 bits fill one 64-bit word

/// The largest coordinate, 2^bits - 1.
KD_HD KD_INLINE constexpr uint32_t lattice_max(int bits) { return (1u << bits) - 1u; }

struct Lattice {
  Vec3d origin{0, 0, 0};  // model space: the box's low corner
  Vec3d extent{0, 0, 0};  // model space: the box's edges, each >= 0; 0 on the axis a flat mesh lacks
  int bits = kDefaultLatticeBits;

  /// Model units per lattice step. An axis without extent gets the step of the longest one (any would do: only q = 0
  /// is used there), so that every lattice has an invertible frame.
  Vec3d step() const {
    const double longest = std::max({extent.x, extent.y, extent.z});
    const double usable = longest > 0 ? longest : 1.0;
    const auto one = [&](double e) { return (e > 0 ? e : usable) / lattice_max(bits); };
    return {one(extent.x), one(extent.y), one(extent.z)};
  }
  /// Steps as shares of the longest one: for areas, which are only compared, and neither overflow nor vanish like this
  /// however large or small the model is.
  Vec3d proportions() const {
    const double longest = std::max({extent.x, extent.y, extent.z});
    const auto one = [&](double e) { return e > 0 ? e / longest : 1.0; };
    return {one(extent.x), one(extent.y), one(extent.z)};
  }
  /// The object's box in lattice space; flat where the mesh is.
  Box3u cube() const {
    const auto top = [&](double e) { return e > 0 ? lattice_max(bits) : 0u; };
    return {{0, 0, 0}, {top(extent.x), top(extent.y), top(extent.z)}};
  }
  /// Lattice space to model space.
  Frame frame() const {
    const Vec3d s = step();
    return {origin, {s.x, 0, 0}, {0, s.y, 0}, {0, 0, s.z}};
  }
  Vec3d to_model(Vec3u q) const { return to_model_space(vec_cast<double>(q)); }
  Vec3d to_model_space(Vec3d p_lattice) const { return origin + p_lattice * step(); }
  /// Unrounded, in lattice steps; clamped to the cube.
  Vec3d to_lattice_space(Vec3d p_model) const {
    const Vec3d s = step();
    const double top = lattice_max(bits);
    const auto one = [&](double p, double o, double h) { return std::clamp((p - o) / h, 0.0, top); };
    return {one(p_model.x, origin.x, s.x), one(p_model.y, origin.y, s.y), one(p_model.z, origin.z, s.z)};
  }
  /// The nearest lattice point, clamped to the cube. Off by at most half a step an axis, plus what double rounding
  /// of the model coordinates themselves costs.
  Vec3u to_lattice(Vec3d p_model) const {
    const Vec3d p = to_lattice_space(p_model);
    return vec_cast<uint32_t>(Vec3d{std::nearbyint(p.x), std::nearbyint(p.y), std::nearbyint(p.z)});
  }
};

}  // namespace kd
