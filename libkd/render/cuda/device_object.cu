#include "render/cuda/device_object.h"

#include <algorithm>

namespace kd::render {

namespace {

__global__ void expand_kernel(PackedTriangles packed, uint32_t count, TriangleVertices* triangles) {
  const uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < count) packed.expand(i, triangles[i]);
}

__global__ void unpack_corners_kernel(PackedTriangles packed, uint32_t count, uint32_t* corners) {
  const uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < count) packed.unpack_corners(i, corners);
}

__global__ void compact_vertices_kernel(PackedTriangles packed, uint32_t count, VertexWord* vertices) {
  const uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < count) packed.compact_vertex(i, vertices);
}

}  // namespace

DeviceObject object_pieces(DeviceMemory& memory, const nkd::Geometry& geometry, TriangleLayout layout) {
  DeviceObject object{};
  object.nodes = memory.piece<Node>(geometry.nodes.size());
  object.references = memory.piece<uint32_t>(geometry.references.size());
  if (layout == TriangleLayout::expanded) {
    object.triangles = memory.piece<TriangleVertices>(geometry.triangle_count());
  } else {
    object.corners = memory.piece<uint32_t>(3 * geometry.triangle_count());
    object.vertices = memory.piece<VertexWord>(geometry.vertex_words());
    object.narrow = geometry.packed().narrow();
  }
  return object;
}

void Staging::include(const nkd::Geometry& geometry) {
  most_vertices_ = std::max(most_vertices_, geometry.vertices.size());
  most_corners_ = std::max(most_corners_, geometry.triangles.size());
}

void Staging::lay_out() {
  memory_.section("packed triangles on their way");
  vertices_ = memory_.piece<uint8_t>(most_vertices_);
  corners_ = memory_.piece<uint8_t>(most_corners_);
}

Result<void> Staging::allocate() {
  lay_out();
  if (auto allocated = memory_.allocate(); !allocated) return allocated;
  lay_out();
  return {};
}

cudaError_t fill_object(const DeviceObject& object, const Staging& staging, const nkd::Geometry& geometry,
                        cudaStream_t stream) {
  cudaError_t status = upload(object.nodes, geometry.nodes, stream);
  if (status == cudaSuccess) status = upload(object.references, geometry.references, stream);
  if (status == cudaSuccess) status = upload(staging.vertices(), geometry.vertices, stream);
  if (status == cudaSuccess) status = upload(staging.corners(), geometry.triangles, stream);
  if (status != cudaSuccess) return status;
  const auto triangles = static_cast<uint32_t>(geometry.triangle_count());
  const auto vertices = static_cast<uint32_t>(geometry.vertex_count());
  const PackedTriangles packed{
      {staging.corners(), geometry.corner_bits()}, {staging.vertices(), geometry.vertex_bits()}, geometry.form};
  if (object.triangles) {
    expand_kernel<<<blocks_for(triangles), kBlock, 0, stream>>>(packed, triangles, object.triangles);
  } else {
    unpack_corners_kernel<<<blocks_for(triangles), kBlock, 0, stream>>>(packed, triangles, object.corners);
    compact_vertices_kernel<<<blocks_for(vertices), kBlock, 0, stream>>>(packed, vertices, object.vertices);
  }
  return cudaGetLastError();
}

}  // namespace kd::render
