// An object on a device: its nodes and references as they lie on disk, its triangles in a layout.
#pragma once

#include "core/object_view.h"
#include "nkd/contents.h"
#include "render/cuda/cuda.h"
#include "render/cuda/device_memory.h"

namespace kd::render {

/// What traversal reads of an object: of triangles, those of its layout.
struct DeviceObject {
  Node* nodes;
  uint32_t* references;
  TriangleVertices* triangles;
  uint32_t* corners;
  VertexWord* vertices;
  bool narrow;

  ObjectView view(int bits) const { return {nodes, references, triangles, bits, {corners, vertices, narrow}}; }
};

DeviceObject object_pieces(DeviceMemory& memory, const nkd::Geometry& geometry, TriangleLayout layout);

/// Where the packed vertices and corners of one object after the other wait for what they become.
class Staging {
 public:
  /// Room for this object's too; call before `allocate`.
  void include(const nkd::Geometry& geometry);
  Result<void> allocate();
  uint8_t* vertices() const { return vertices_; }
  uint8_t* corners() const { return corners_; }

 private:
  void lay_out();

  DeviceMemory memory_;
  size_t most_vertices_ = 0, most_corners_ = 0;  // bytes
  uint8_t* vertices_ = nullptr;
  uint8_t* corners_ = nullptr;
};

cudaError_t fill_object(const DeviceObject& object, const Staging& staging, const nkd::Geometry& geometry,
                        cudaStream_t stream);

}  // namespace kd::render
