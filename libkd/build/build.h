// Building an object's kd-tree: greedy, by the surface area heuristic, with perfect splits (Wald and Havran 2006).
//
// Split planes are lattice planes, so which side of one a vertex lies on is integer arithmetic. The tree is the same
// for any number of threads.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/lattice.h"
#include "core/node.h"
#include "core/sah.h"
#include "sys/progress.h"
#include "sys/result.h"

namespace kd::build {

struct BuildSettings {
  SahCosts costs;
  int max_depth = kMaxDepth;  // in inner nodes, at most kMaxDepth
};

struct Tree {
  std::vector<Node> nodes;           // as core/node.h says
  std::vector<uint32_t> references;  // leaf order -> triangle, ascending within a leaf
};

/// The tree over triangles on a lattice. Errors: ErrorClass::resource for a tree of more than 2^27 nodes or 2^32
/// references, ErrorClass::interrupted if `progress` said so.
Result<Tree> build_tree(const Lattice& lattice, std::span<const Vec3u> vertices,
                        std::span<const std::array<uint32_t, 3>> triangles, const BuildSettings& settings,
                        const Progress& progress = {});

}  // namespace kd::build
