// An object on a device: its sections as they lie on disk, its triangles expanded.
#pragma once

#include "core/object_view.h"
#include "nkd/contents.h"
#include "render/cuda/cuda.h"
#include "render/cuda/device_memory.h"

namespace kd::render {

/// What traversal reads of an object.
struct DeviceObject {
  Node* nodes;
  uint32_t* references;
  TriangleVertices* triangles;
};

DeviceObject object_pieces(DeviceMemory& memory, const nkd::Geometry& geometry);

/// Where the packed vertices and corners of one object after the other wait for their expansion.
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
