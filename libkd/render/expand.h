// What a loaded object still lacks before the CPU can trace it: its triangles as corners instead of indices.
#pragma once

#include <vector>

#include "core/object_view.h"
#include "nkd/contents.h"

namespace kd::render {

/// The triangles of an object in lattice coordinates, in the object's order; a parallel loop.
std::vector<TriangleVertices> expand_triangles(const nkd::Geometry& geometry, int bits);

}  // namespace kd::render
