#include "render/expand.h"

#include "sys/parallel.h"

namespace kd::render {

namespace {

constexpr size_t kTriangleGrain = 8192;

template <class T>
const T* data_or_null(std::span<const T> s) {
  return s.empty() ? nullptr : s.data();
}

}  // namespace

HugeArray<TriangleVertices> expand_triangles(const nkd::Geometry& geometry) {
  const PackedTriangles packed = geometry.packed();
  HugeArray<TriangleVertices> triangles(geometry.triangle_count());
  parallel_ranges(triangles.size(), kTriangleGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) packed.expand(i, triangles[i]);
  });
  return triangles;
}

ExpandedObjects::ExpandedObjects(const LoadedScene& scene)
    : triangles(scene.objects.size()), views(scene.objects.size()) {
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    if (!scene.objects[i].file) continue;
    const nkd::ObjectFile& file = *scene.objects[i].file;
    const nkd::Attributes& a = scene.objects[i].attributes;
    const int bits = file.summary().lattice.bits;
    triangles[i] = expand_triangles(file.geometry());
    views[i] = {{file.geometry().nodes.data(), file.geometry().references.data(), triangles[i].data(), bits},
                file.summary().lattice.step(),
                data_or_null(a.source_primitives),
                data_or_null(a.normals),
                data_or_null(a.normal_indices),
                data_or_null(a.materials),
                data_or_null(a.material_ids)};
  }
}

}  // namespace kd::render
