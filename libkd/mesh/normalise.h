// Normalising: a mesh's bounding box becomes the unit cube, its vertices points of the lattice.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/box.h"
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

/// Model space: around the corners of the mesh's triangles.
Box3d bounds(const Mesh& mesh);

/// `mesh` is clean: finite, with at least one triangle. Its bounding box may be flat along one axis or more.
LatticeMesh normalise(const Mesh& mesh, int bits);

/// The same in a given box of model space, in which all of `mesh` lies. Parts of a mesh that are normalised in one box
/// lie on one lattice: vertices that they share stay shared, so that no seam opens between them.
///
/// In the float32 form, `bits` is kMaxLatticeBits. A vertex is rounded to float32, which is what displacements measure
/// and welding compares, and from there to the lattice, which is where the tree sees it and triangles collapse: at most
/// 3/4 of a step from where it was, and not always the point that one rounding would have given.
LatticeMesh normalise(const Mesh& mesh, int bits, const Box3d& box_model, VertexForm form = VertexForm::lattice);

/// What `normalise` would give as LatticeMesh::max_displacement on `lattice`, at a fraction of the cost. Stops at the
/// first displacement above `enough` and returns that.
double max_displacement(const Mesh& mesh, const Lattice& lattice,
                        double enough = std::numeric_limits<double>::infinity());

/// Fewer bits than this are not worth looking for: four bytes a vertex.
constexpr int kFewestUsefulBits = 10;

/// The fewest bits, from kFewestUsefulBits on, with which no vertex of these meshes, all on one lattice over `box`,
/// moves further than `allowed` (model units); nothing if kMaxLatticeBits do not keep it. More bits may move a vertex
/// further (one that fewer happened to hit), so every number of bits is tried in turn; those that are too few are found
/// out after a vertex or two.
std::optional<int> fewest_bits(std::span<const Mesh* const> meshes, const Box3d& box, double allowed);

}  // namespace kd::mesh
