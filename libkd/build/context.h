// What every step of one build knows: the mesh on its lattice, and the rules by which it is split.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "build/clip.h"
#include "core/box.h"
#include "core/sah.h"

namespace kd::build {

struct Context {
  std::span<const Vec3u> vertices;
  std::span<const std::array<uint32_t, 3>> triangles;
  Vec3d step;  // the lattice's, model units
  SahCosts costs;
  int max_depth = 0;  // in inner nodes

  LatticeTriangle corners(uint32_t triangle) const {
    const auto& t = triangles[triangle];
    return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
  }
  /// What a leaf of this many triangles costs: a split that is not cheaper is not made.
  double leaf_cost(uint32_t count) const { return costs.intersection * count; }
};

}  // namespace kd::build
