#include "object_triangles.h"

namespace kd::bench {

namespace {

/// Source primitive -> the object's triangle; the identity if the object dropped none.
std::vector<uint32_t> triangle_of_primitive(std::span<const uint32_t> sources, size_t triangles) {
  std::vector<uint32_t> map;
  for (uint32_t i = 0; i < triangles; ++i) {
    const uint32_t primitive = sources.empty() ? i : sources[i];
    if (primitive >= map.size()) map.resize(primitive + 1, kNoTriangle);
    map[primitive] = i;
  }
  return map;
}

}  // namespace

ObjectTriangles::ObjectTriangles(const nkd::ObjectFile& object)
    : lattice_(object.summary().lattice),
      packed_(object.geometry().packed()),
      map_(triangle_of_primitive(object.source_primitives() ? *object.source_primitives() : std::span<const uint32_t>{},
                                 object.geometry().triangle_count())) {}

Corners ObjectTriangles::corners(int64_t primitive) const {
  const Vec3u c = packed_.corners[map_[static_cast<size_t>(primitive)]];
  const auto corner = [&](uint32_t v) { return lattice_.to_model_space(vec_cast<double>(packed_.position(v))); };
  return {corner(c.x), corner(c.y), corner(c.z)};
}

}  // namespace kd::bench
