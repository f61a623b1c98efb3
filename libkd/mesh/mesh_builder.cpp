#include "mesh/mesh_builder.h"

#include <algorithm>

#include <fmt/format.h>

#include "mesh/polygon.h"

namespace kd::mesh {

Result<void> MeshBuilder::add_face(std::span<const Corner> corners, uint16_t material) {
  const uint64_t face = faces_++;
  const auto failed = [](std::string what) { return Error{ErrorClass::mesh, "", std::move(what)}; };
  for (const Corner& corner : corners) {
    if (corner.position < 0 || static_cast<uint64_t>(corner.position) >= mesh.positions.size()) {
      return failed(fmt::format("face {} (from 0) uses vertex {} (from 0), but there are {}; export the mesh again",
                                face, corner.position, mesh.positions.size()));
    }
  }
  if (corners.size() < 3) {
    ++short_faces_;
    return {};
  }
  if (mesh.positions.size() >= kNoIndex || mesh.triangles.size() + corners.size() >= kNoIndex) {
    return failed("more vertices or triangles than 32 bits can number; split the mesh");
  }
  if (corners.size() > 3) {
    polygon_.clear();
    for (const Corner& corner : corners) polygon_.push_back(mesh.positions[static_cast<size_t>(corner.position)]);
    triangulate_polygon(polygon_, fan_);
  } else {
    fan_.assign(1, {0, 1, 2});
  }
  for (const auto& t : fan_) {
    const Corner &a = corners[t[0]], &b = corners[t[1]], &c = corners[t[2]];
    mesh.source_primitives.push_back(static_cast<uint32_t>(mesh.triangles.size()));
    mesh.triangles.push_back(
        {static_cast<uint32_t>(a.position), static_cast<uint32_t>(b.position), static_cast<uint32_t>(c.position)});
    mesh.normal_indices.push_back({a.normal, b.normal, c.normal});
    mesh.material_ids.push_back(material);
  }
  return {};
}

Result<Mesh> MeshBuilder::finish(const std::string& path) && {
  if (short_faces_ > 0) {
    mesh.warnings.push_back(fmt::format("{} face(s) with fewer than three corners left out", short_faces_));
  }
  if (mesh.triangles.empty()) return Error{ErrorClass::mesh, path, "no faces: the file holds no surface to compile"};
  const bool has_normals = std::any_of(mesh.normal_indices.begin(), mesh.normal_indices.end(), [](const auto& n) {
    return n[0] != kNoIndex || n[1] != kNoIndex || n[2] != kNoIndex;
  });
  if (!has_normals) {
    mesh.normals.clear();
    mesh.normal_indices.clear();
  }
  if (mesh.materials.empty()) mesh.material_ids.clear();
  return std::move(mesh);
}

uint32_t add_normal(Mesh& mesh, Vec3d normal) {
  const Vec3d unit = normalised(normal);
  const double squared = dot(unit, unit);
  if (!is_finite(normal) || !(squared > 0.5 && squared < 1.5)) return kNoIndex;
  mesh.normals.push_back(vec_cast<float>(unit));
  return static_cast<uint32_t>(mesh.normals.size() - 1);
}

}  // namespace kd::mesh
