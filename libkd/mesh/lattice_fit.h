// The lattice of a mesh, or of several that share one, and the point of it to which each vertex goes. Both are chosen
// so that faces stay where they are, because depth, normals and shadows follow faces, not vertices.
//
//   - The box may grow by kMostGrowth steps an axis, so that the largest planes across the axis (floors, walls) come to
//     lie nearer to lattice planes.
//   - Of the lattice points around it a vertex takes the one that brings the triangles around it least out of their
//     planes: least quadric error, the sum over them of area x squared distance from the plane (Garland and Heckbert,
//     "Surface Simplification Using Quadric Error Metrics", SIGGRAPH 1997). It may move by up to a step an axis, where
//     rounding moves it by half a step. What decides between points that are equally good, or nearly, is distance.
//   - An edge that lies across an axis stays so: its ends go to the nearest plane. Rows of a grid and the outlines of
//     walls remain where a tree can part them without cutting triangles.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/box.h"
#include "core/lattice.h"
#include "mesh/mesh.h"

namespace kd::mesh {

/// Model space: around the corners of the mesh's triangles.
Box3d bounds(const Mesh& mesh);

/// The largest distance (model units) by which rounding to the nearest point of `lattice` moves a vertex of the mesh.
/// Stops at the first above `enough` and returns that.
double rounding_displacement(const Mesh& mesh, const Lattice& lattice,
                             double enough = std::numeric_limits<double>::infinity());

/// Fewer bits than this are not worth looking for: four bytes a vertex.
constexpr int kFewestUsefulBits = 10;

/// Steps. With fewer bits than kFewestUsefulBits the box does not grow.
constexpr int kMostGrowth = 2;

class LatticeFit {
 public:
  /// Of clean meshes: finite, with at least one triangle each; their box may be flat along one axis or more. They
  /// outlive this. O(N log N), about 50 bytes a vertex.
  explicit LatticeFit(std::span<const Mesh* const> meshes);

  /// A box that contains the meshes: as tight as it can be where no planes gain by another.
  Lattice lattice(int bits) const;

  /// The points of all positions of meshes[mesh]. Equal positions, of one mesh or of several, have one point, so no
  /// seam opens; those on a lattice point stay there. Only the nearest point may be further than `reach` (model units).
  /// The same for any number of threads. Positions that are not finite, which no triangle uses, are at 0.
  std::vector<Vec3u> place(size_t mesh, const Lattice& lattice,
                           double reach = std::numeric_limits<double>::infinity()) const;

  /// The fewest bits, from kFewestUsefulBits on, with which no vertex need move further than `allowed` (model units),
  /// and none does that is placed with that reach; nothing if kMaxLatticeBits do not keep it. More bits may move a
  /// vertex further (one that fewer happened to hit), so every number of bits is tried in turn; those that are too few
  /// are found out after a vertex or two.
  std::optional<int> fewest_bits(double allowed) const;

  /// A symmetric 3 x 3 matrix.
  struct Quadric {
    double xx = 0, yy = 0, zz = 0, xy = 0, yz = 0, zx = 0;
  };
  /// Triangles in one plane across an axis, or nearly.
  struct Plane {
    double position = 0;  // from the box's low to its high side, 0 to 1
    double area = 0;      // twice, where the box's longest edge is 1
  };

 private:
  void add_triangle(const Mesh& mesh, size_t first_vertex, const std::array<uint32_t, 3>& triangle);
  std::vector<Plane> largest_planes(int axis) const;

  std::vector<const Mesh*> meshes_;
  Box3d box_;
  std::vector<size_t> first_vertex_;          // of each mesh, among the positions of all
  std::vector<uint32_t> first_equal_;         // per position, the first that equals it: it has their quadric
  std::vector<Quadric> quadrics_;             // per position; lengths as those of Plane::area
  std::vector<uint8_t> held_;                 // per position: axes, as bits, that an edge from it lies across
  std::array<std::vector<Plane>, 3> planes_;  // by axis: the largest, in that order
};

}  // namespace kd::mesh
