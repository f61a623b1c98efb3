// The surface area heuristic for kd-trees (MacDonald and Booth 1990; Wald and Havran, "On building fast kd-trees for
// ray tracing, and on doing that in O(N log N)", 2006): costs relative to one another, areas as probabilities.
#pragma once

#include "core/vec.h"

namespace kd {

struct SahCosts {
  double traversal = 1;       // of a step through an inner node
  double intersection = 1.5;  // of a triangle test
  double empty_bonus = 0.08;  // share of a split's cost that is forgiven where it cuts off empty space
  /// What memory is worth: a split has to lower the tree's SAH cost by this much for each byte a triangle that it adds.
  double byte_price = 0.35;
};

/// Half the surface of a box with these edges. Every use is a ratio of two.
KD_HD KD_INLINE double half_area(Vec3d edges) { return edges.x * edges.y + edges.y * edges.z + edges.z * edges.x; }

}  // namespace kd
