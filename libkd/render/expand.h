// What a loaded object still lacks before the CPU can trace it: its triangles as corners instead of indices.
#pragma once

#include <vector>

#include "core/object_view.h"
#include "nkd/contents.h"
#include "render/load.h"
#include "sys/huge_array.h"

namespace kd::render {

/// The triangles of an object in lattice coordinates, in the object's order; a parallel loop.
HugeArray<TriangleVertices> expand_triangles(const nkd::Geometry& geometry);

/// A scene's objects as the stages see them: sections where they are mapped, triangles expanded.
struct ExpandedObjects {
  explicit ExpandedObjects(const LoadedScene& scene);

  std::vector<HugeArray<TriangleVertices>> triangles;
  std::vector<ShadedObjectView> views;
};

}  // namespace kd::render
