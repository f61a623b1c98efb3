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
  Vec3d step;  // the lattice's proportions
  SahCosts costs;
  double area_price = 0;  // SAH cost of a byte, times the surface of the cell it is spent on
  int max_depth = 0;      // in inner nodes

  LatticeTriangle corners(uint32_t triangle) const {
    const auto& t = triangles[triangle];
    return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
  }
  /// Half of a cell's surface, where rays are: in model space, up to scale.
  double half_area_of(const Box3u& cell) const { return half_area(vec_cast<double>(cell.extent()) * step); }
};

}  // namespace kd::build
