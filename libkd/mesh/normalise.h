// Normalising: a mesh's box becomes the unit cube, its vertices points of the lattice.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/lattice.h"
#include "core/object_view.h"
#include "mesh/mesh.h"

namespace kd::mesh {

/// A mesh on the lattice: what the tree is built over. Triangles keep the order of the source; vertices stand in order
/// of first use, each lattice point once, or in the float32 form each triple of floats.
struct LatticeMesh {
  Lattice lattice;
  std::vector<Vec3u> vertices;                     // lattice space
  std::vector<Vec3f> float_vertices;               // the float32 form only: what is stored of each; lattice space
  std::vector<std::array<uint32_t, 3>> triangles;  // indices into vertices
  std::vector<uint32_t> kept;                      // per triangle: its number in the mesh that was normalised
  double max_displacement = 0;                     // model units: the largest distance a vertex moved, dropped ones too
  double rms_displacement = 0;                     // model units, over the vertices in use
  uint64_t welded_vertices = 0;                    // distinct positions that are stored as an earlier one is
  uint64_t collapsed_triangles = 0;     // without area on the lattice: no ray can meet them, so they are dropped
  uint32_t first_collapsed = kNoIndex;  // source primitive of the first of them
};

/// On a lattice of its own, its vertices placed there (mesh/lattice_fit.h). `mesh` is clean: finite, with at least one
/// triangle. Its bounding box may be flat along one axis or more.
LatticeMesh normalise(const Mesh& mesh, int bits);

/// On a given lattice, in whose box all of `mesh` lies. A vertex goes to its lattice point, or if the mesh has none
/// yet, to the nearest one. Vertices that parts of a mesh share stay shared if they were placed together, or not at
/// all.
///
/// In the float32 form, the lattice has kMaxLatticeBits bits, and points do not count. A vertex is rounded to float32,
/// which is what displacements measure and welding compares, and from there to the lattice, which is where the tree
/// sees it and triangles collapse: at most 3/4 of a step from where it was, and not always the point that one rounding
/// would have given.
LatticeMesh normalise(const Mesh& mesh, const Lattice& lattice, VertexForm form = VertexForm::lattice);

}  // namespace kd::mesh
