#include "render/expand.h"

#include "sys/parallel.h"

namespace kd::render {

namespace {

constexpr size_t kTriangleGrain = 8192;

}  // namespace

std::vector<TriangleVertices> expand_triangles(const nkd::Geometry& geometry, int bits) {
  std::vector<TriangleVertices> triangles(geometry.triangle_count());
  parallel_ranges(triangles.size(), kTriangleGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      triangles[i] = expand_triangle(geometry.vertices.data(), geometry.triangles.data() + 3 * i, bits);
    }
  });
  return triangles;
}

}  // namespace kd::render
