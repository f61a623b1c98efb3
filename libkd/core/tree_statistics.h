// What a tree looks like and costs, measured by walking it.
#pragma once

#include <cstdint>
#include <span>

#include "core/box.h"
#include "core/lattice.h"
#include "core/node.h"
#include "core/sah.h"

namespace kd {

/// Of a triangle of a visited leaf, where a visit of an inner node costs 1: what trees are compared by.
constexpr double kIntersectionCost = 1.5;

struct TreeStatistics {
  /// sum over inner nodes of SA(n)/SA(root) + 1.5 x sum over leaves of references x SA(leaf)/SA(root), areas in model
  /// space, root the mesh's tight box. The figure by which kd-trees are compared.
  double sah_cost = 0;
  uint32_t inner_nodes = 0;
  uint32_t leaves = 0;
  uint32_t empty_leaves = 0;
  uint32_t depth = 0;  // longest path, in inner nodes
  uint32_t largest_leaf = 0;

  friend bool operator==(const TreeStatistics&, const TreeStatistics&) = default;
};

/// Calls visit(index, node, cell, depth) for every cell of a valid tree, parents first; `cell` in lattice space. Empty
/// cells share the node kEmptyLeaf.
template <class Visit>
void for_each_node(std::span<const Node> nodes, const Lattice& lattice, const Visit& visit) {
  struct Open {
    uint32_t index;
    uint32_t depth;
    Box3u cell;
  };
  Open stack[kMaxDepth + 1];
  int open = 0;
  stack[open++] = {0, 0, lattice.cube()};
  while (open > 0) {
    const Open current = stack[--open];
    const Node node = nodes[current.index];
    visit(current.index, node, current.cell, current.depth);
    if (is_leaf(node)) continue;
    Open below{child_of(node, 0), current.depth + 1, current.cell};
    Open above{child_of(node, 1), current.depth + 1, current.cell};
    const auto plane = static_cast<uint32_t>(split_plane(node));
    below.cell.hi.set(split_axis(node), plane);
    above.cell.lo.set(split_axis(node), plane);
    stack[open++] = above;
    stack[open++] = below;
  }
}

inline TreeStatistics tree_statistics(std::span<const Node> nodes, const Lattice& lattice) {
  TreeStatistics s;
  const Vec3d step = lattice.proportions();
  const double root_area = half_area(vec_cast<double>(lattice.cube().extent()) * step);
  for_each_node(nodes, lattice, [&](uint32_t, Node node, const Box3u& cell, uint32_t depth) {
    const double share = root_area > 0 ? half_area(vec_cast<double>(cell.extent()) * step) / root_area : 1;
    s.depth = std::max(s.depth, depth);
    if (is_leaf(node)) {
      const uint32_t count = reference_count(node);
      ++s.leaves;
      s.empty_leaves += count == 0;
      s.largest_leaf = std::max(s.largest_leaf, count);
      s.sah_cost += kIntersectionCost * count * share;
    } else {
      ++s.inner_nodes;
      s.sah_cost += share;
    }
  });
  return s;
}

}  // namespace kd
