// Clipping a triangle to a cell, for perfect splits: the lattice box of what of the triangle lies in the cell.
#pragma once

#include <array>
#include <optional>

#include "core/box.h"
#include "core/vec.h"

namespace kd::build {

using LatticeTriangle = std::array<Vec3u, 3>;

inline Box3u bounds(const LatticeTriangle& t) {
  Box3u box;
  for (Vec3u p : t) box.extend(p);
  return box;
}

/// The smallest lattice box around the triangle's part in the closed cell, or one a step larger: never too small.
/// Nothing if the triangle has no point in the cell.
///
/// Sutherland and Hodgman's clipping, in double. Coordinates that are known exactly are cut exactly; those that were
/// computed are taken to be uncertain by 2^-20 steps, far more than they are, always to the larger side.
std::optional<Box3u> clipped_bounds(const LatticeTriangle& triangle, const Box3u& cell);

}  // namespace kd::build
