// What a loaded object still lacks before it can be traced: its triangles, in a layout.
#pragma once

#include <vector>

#include "core/object_view.h"
#include "nkd/contents.h"
#include "render/load.h"
#include "sys/huge_array.h"

namespace kd::render {

/// Bytes of what traversal reads: nodes, references, triangles.
uint64_t traversal_bytes(const nkd::Geometry& geometry, TriangleLayout layout);

/// The triangles of an object in lattice coordinates, in the object's order; a parallel loop.
HugeArray<TriangleVertices> expand_triangles(const nkd::Geometry& geometry);

/// An object as the CPU traverses it: nodes and references where they are mapped, triangles in a layout.
class HostObject {
 public:
  HostObject(const nkd::Geometry& geometry, TriangleLayout layout);

  /// Valid as long as this and the geometry's sections are.
  ObjectView view() const;

 private:
  nkd::Geometry geometry_;
  HugeArray<TriangleVertices> triangles_;  // expanded
  HugeArray<uint32_t> corners_;            // compact
  HugeArray<VertexWord> vertices_;
};

/// A scene's objects as the stages see them.
struct HostObjects {
  HostObjects(const LoadedScene& scene, TriangleLayout layout);

  std::vector<HostObject> objects;  // what the views point to
  std::vector<ShadedObjectView> views;
};

}  // namespace kd::render
