// How the triangles of a mesh hang together.
#pragma once

#include <cstdint>

#include "mesh/mesh.h"

namespace kd::mesh {

/// Counts over vertices welded by value of position. Triangles with two corners in one place have no edges here.
struct Topology {
  uint64_t vertices = 0;  // places that some triangle uses
  uint64_t edges = 0;
  uint64_t boundary_edges = 0;      // edges of one triangle
  uint64_t non_manifold_edges = 0;  // edges of more than two
  uint64_t inconsistent_edges = 0;  // edges of exactly two that both run them in the same direction
  uint64_t components = 0;          // sets of triangles linked by shared vertices
  bool closed = false;              // edges, and all of them with exactly two triangles
};

/// O(N log N) on one core.
Topology topology(const Mesh& mesh);

}  // namespace kd::mesh
