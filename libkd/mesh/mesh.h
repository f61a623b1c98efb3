// A mesh: triangles in model space, as the source file gave them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/material.h"
#include "core/vec.h"

namespace kd::mesh {

constexpr uint32_t kNoIndex = 0xffffffffu;

struct Mesh {
  std::vector<Vec3d> positions;                    // model space
  std::vector<Vec3u> lattice_points;               // per position, once mesh/lattice_fit.h has placed them; else empty
  std::vector<std::array<uint32_t, 3>> triangles;  // indices into positions
  std::vector<uint32_t> source_primitives;         // per triangle: its number in the source, polygons fanned, from 0
  std::vector<Vec3f> normals;                      // length 1; empty if the source has none
  std::vector<std::array<uint32_t, 3>> normal_indices;  // per triangle and corner, or kNoIndex; empty if no normals
  std::vector<Material> materials;                      // empty if the source names none
  std::vector<std::string> material_names;              // one per material
  std::vector<uint16_t> material_ids;                   // per triangle; empty if no materials
  std::vector<std::string> group_names;                 // empty if the source has no groups
  std::vector<uint32_t> group_ids;                      // per triangle; empty if no groups
  std::vector<std::string> warnings;                    // what the reader had to replace or leave out, a line each
  std::vector<std::string> dependencies;                // paths of the further files it is made of: mesh/dependencies.h
};

}  // namespace kd::mesh
