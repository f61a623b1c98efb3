// Clipping a triangle to a cell, for perfect splits: the lattice box of what of the triangle lies in the cell.
#pragma once

#include <array>

#include "core/box.h"
#include "core/vec.h"

namespace kd::build {

using LatticeTriangle = std::array<Vec3u, 3>;

inline Box3u bounds(const LatticeTriangle& t) {
  Box3u box;
  for (Vec3u p : t) box.extend(p);
  return box;
}

/// Empty where the triangle has no point in the cell.
struct SplitBounds {
  Box3u below, above;
};

/// The smallest lattice boxes around the triangle's parts in the two closed cells that a plane inside `cell` makes of
/// it, or boxes a step larger: never too small.
///
/// Sutherland and Hodgman's clipping, in double. Coordinates that are known exactly are cut exactly; those that were
/// computed are taken to be uncertain by 2^-20 steps, far more than they are, always to the larger side.
SplitBounds split_bounds(const LatticeTriangle& triangle, const Box3u& cell, int axis, uint32_t plane);

}  // namespace kd::build
