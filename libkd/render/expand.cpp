#include "render/expand.h"

#include "sys/parallel.h"

namespace kd::render {

namespace {

constexpr size_t kTriangleGrain = 8192;

}  // namespace

HugeArray<TriangleVertices> expand_triangles(const nkd::Geometry& geometry) {
  const PackedTriangles packed = geometry.packed();
  HugeArray<TriangleVertices> triangles(geometry.triangle_count());
  parallel_ranges(triangles.size(), kTriangleGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) packed.expand(i, triangles[i]);
  });
  return triangles;
}

}  // namespace kd::render
