#include "render/expand.h"

#include "sys/parallel.h"

namespace kd::render {

namespace {

constexpr size_t kTriangleGrain = 8192;

/// f(i) for each of `count` triangles or vertices; a parallel loop.
template <class F>
void for_each_element(size_t count, const F& f) {
  parallel_ranges(count, kTriangleGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) f(i);
  });
}

template <class T>
const T* data_or_null(std::span<const T> s) {
  return s.empty() ? nullptr : s.data();
}

}  // namespace

uint64_t traversal_bytes(const nkd::Geometry& geometry, TriangleLayout layout) {
  const size_t count = geometry.triangle_count();
  const size_t triangles = layout == TriangleLayout::expanded
                               ? count * sizeof(TriangleVertices)
                               : 3 * count * sizeof(uint32_t) + geometry.vertex_words() * sizeof(VertexWord);
  return geometry.nodes.size_bytes() + geometry.references.size_bytes() + triangles;
}

HugeArray<TriangleVertices> expand_triangles(const nkd::Geometry& geometry) {
  const PackedTriangles packed = geometry.packed();
  HugeArray<TriangleVertices> triangles(geometry.triangle_count());
  for_each_element(triangles.size(), [&](size_t i) { packed.expand(i, triangles[i]); });
  return triangles;
}

HostObject::HostObject(const nkd::Geometry& geometry, TriangleLayout layout) : geometry_(geometry) {
  if (layout == TriangleLayout::expanded) {
    triangles_ = expand_triangles(geometry);
    return;
  }
  const PackedTriangles packed = geometry.packed();
  corners_ = HugeArray<uint32_t>(3 * geometry.triangle_count());
  vertices_ = HugeArray<VertexWord>(geometry.vertex_words());
  for_each_element(geometry.triangle_count(), [&](size_t i) { packed.unpack_corners(i, corners_.data()); });
  for_each_element(geometry.vertex_count(), [&](size_t i) { packed.compact_vertex(i, vertices_.data()); });
}

ObjectView HostObject::view() const {
  return {geometry_.nodes.data(),
          geometry_.references.data(),
          triangles_.size() > 0 ? triangles_.data() : nullptr,
          geometry_.bits,
          {corners_.data(), vertices_.data(), geometry_.packed().narrow()}};
}

HostObjects::HostObjects(const LoadedScene& scene, TriangleLayout layout) : views(scene.objects.size()) {
  objects.reserve(scene.objects.size());
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    const nkd::ObjectFile& file = scene.objects[i].file;
    const nkd::Attributes& a = scene.objects[i].attributes;
    views[i] = {objects.emplace_back(file.geometry(), layout).view(),
                file.summary().lattice.step(),
                data_or_null(a.source_primitives),
                data_or_null(a.normals),
                data_or_null(a.normal_indices),
                data_or_null(a.materials),
                data_or_null(a.material_ids)};
  }
}

}  // namespace kd::render
