// The surface area heuristic for kd-trees (MacDonald and Booth 1990; Wald and Havran, "On building fast kd-trees for
// ray tracing, and on doing that in O(N log N)", 2006): what a split is expected to cost a ray that meets the cell.
#pragma once

#include "core/vec.h"

namespace kd {

struct SahCosts {
  double traversal = 1;
  double intersection = 1.5;
  double empty_bonus = 0.15;  // share of a split's cost that is forgiven where it cuts off empty space
};

/// Half the surface of a box with these edges. Every use is a ratio of two.
KD_HD KD_INLINE double half_area(Vec3d edges) { return edges.x * edges.y + edges.y * edges.z + edges.z * edges.x; }

/// The expected cost of a split into cells that are met with probability p_left and p_right and hold n_left and n_right
/// triangles. To compare with `intersection * n` of a leaf.
inline double split_cost(const SahCosts& costs, double p_left, double p_right, uint32_t n_left, uint32_t n_right) {
  const double cost = costs.traversal + costs.intersection * (p_left * n_left + p_right * n_right);
  return n_left == 0 || n_right == 0 ? cost * (1 - costs.empty_bonus) : cost;
}

}  // namespace kd
