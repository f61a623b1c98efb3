// Splitting: a mesh becomes several, each with only the vertices, normals and materials that its own triangles use.
// Triangles keep their order and their source_primitives, vertices stand in order of first use, groups are not kept and
// warnings stay with the whole. What is split once its vertices have lattice points stays on one lattice, without
// seams.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "mesh/mesh.h"

namespace kd::mesh {

struct MeshPart {
  std::string name;  // the group's or the material's
  Mesh mesh;
};

/// One part for each group that has a triangle, in the order of the groups. The mesh has groups. O(N).
std::vector<MeshPart> split_by_group(const Mesh& mesh);

/// One part for each material that has a triangle, in the order of the materials. The mesh has materials. O(N).
std::vector<MeshPart> split_by_material(const Mesh& mesh);

/// Halves, their numbers of triangles at most one apart: the triangles whose centroids come first along the longest
/// axis of the centroids' bounds, and the rest; where centroids coincide, earlier triangles come first. The mesh has
/// two triangles or more. O(N).
std::pair<Mesh, Mesh> split_in_halves(const Mesh& mesh);

/// The `count` triangles whose centroids are nearest to that of triangle `seed`, by their largest difference along an
/// axis; all if there are no more. Of those equally near, earlier ones. O(N).
Mesh neighbourhood(const Mesh& mesh, uint32_t seed, size_t count);

}  // namespace kd::mesh
