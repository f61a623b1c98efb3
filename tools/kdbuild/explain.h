// Why a tree costs what it costs: where its SAH cost lies, what its leaves hold, how often triangles repeat.
//
// A ray that meets the mesh's box is expected to meet a cell with probability SA(cell)/SA(root): "visits" are sums of
// these. Costs are those of tree_statistics.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/lattice.h"
#include "core/node.h"
#include "core/tree_statistics.h"

namespace kd::tools {

/// What lies at one depth, in inner nodes from the root.
struct Level {
  uint64_t inner_nodes = 0;
  uint64_t leaves = 0;
  double traversal_cost = 0;
  double intersection_cost = 0;
};

/// Of a histogram over whole numbers: one bin a number up to 8, then 9 to 16, 17 to 32 and so on.
struct Bin {
  uint32_t lowest = 0;
  uint32_t highest = 0;
  uint64_t count = 0;
  double visits = 0;  // leaves only
};

struct Explanation {
  uint64_t triangles = 0;
  uint64_t inner_nodes = 0;
  uint64_t leaves = 0;
  uint64_t references = 0;
  double traversal_cost = 0;
  double intersection_cost = 0;
  std::vector<Level> levels;    // by depth, from 0
  std::vector<Bin> leaf_sizes;  // leaves by the references they hold
  double leaf_visits = 0;       // of all leaves
  uint64_t empty_leaves = 0;
  double empty_volume = 0;  // share of the box
  double empty_visits = 0;
  std::vector<Bin> triangle_references;  // triangles by how many leaves hold them
  uint32_t median_references = 0;        // of a triangle
  uint32_t references_95 = 0;            // at least 95 % of the triangles have no more
  uint32_t most_references = 0;

  double sah_cost() const { return traversal_cost + intersection_cost; }
  double mean_references() const { return static_cast<double>(references) / static_cast<double>(triangles); }
  double nodes_per_triangle() const {
    return static_cast<double>(inner_nodes + leaves) / static_cast<double>(triangles);
  }
};

/// Of a valid tree over at least one triangle.
Explanation explain(std::span<const Node> nodes, std::span<const uint32_t> references, size_t triangles,
                    const Lattice& lattice);

/// A bin as text: "3", "9-16".
std::string bin_name(const Bin& bin);

}  // namespace kd::tools
