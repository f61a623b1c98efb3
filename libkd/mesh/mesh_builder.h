// What the readers share: faces in file order become numbered triangles of a mesh, every index checked.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mesh/mesh.h"
#include "sys/result.h"

namespace kd::mesh {

class MeshBuilder {
 public:
  /// Corner of a face: an index into the mesh's positions and one into its normals, or kNoIndex.
  struct Corner {
    int64_t position = 0;
    uint32_t normal = kNoIndex;
  };

  /// Positions and normals are put here by the reader, before the faces that use them.
  Mesh mesh;

  /// Appends the triangles of one face. Fewer than three corners are counted and left out. ErrorClass::mesh, without a
  /// place, if a position does not exist or the mesh outgrows 32-bit indices.
  Result<void> add_face(std::span<const Corner> corners, uint16_t material = 0);

  /// The mesh, or ErrorClass::mesh if it has no triangle. Drops what turned out unused: normals that no corner has.
  Result<Mesh> finish(const std::string& path) &&;

 private:
  uint64_t faces_ = 0;
  uint64_t short_faces_ = 0;
  std::vector<Vec3d> polygon_;
  std::vector<std::array<uint32_t, 3>> fan_;
};

/// Appends a normal scaled to length 1 and returns its index, or kNoIndex for one that is zero or not finite.
uint32_t add_normal(Mesh& mesh, Vec3d normal);

}  // namespace kd::mesh
