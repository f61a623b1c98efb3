// What is true of a mesh, for measuring errors against: rays and nearest points in double precision, on triangles as
// the source file has them, through a plain bounding volume hierarchy. Nothing here is shared with the traversal that
// is measured.
//
// Rays are watertight: the triangle is sheared along the ray as Woop, Benthin and Wald do ("Watertight Ray/Triangle
// Intersection", JCGT 2013), so that triangles with a common edge see the same sign of the same number, and a ray
// through it meets both. A distance is good to a few 2^-53 of the coordinates involved, over the cosine at which it
// meets the surface.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/box.h"
#include "core/ray.h"
#include "corners.h"

namespace kd::bench {

struct ReferenceHit {
  int64_t triangle = -1;  // its place in the list of triangles; -1: none
  double t = 0;
  double u = 0;  // weights of the second and third corner
  double v = 0;
};

/// Whether the ray meets the triangle for some t, inside or on its border, and where. Triangles without area, or seen
/// edge-on, are missed. The direction is not zero.
bool meets(const Ray& ray, const Corners& corners, ReferenceHit& hit);

/// The point of the triangle nearest to p.
Vec3d nearest_point(const Corners& corners, Vec3d p);

class ReferenceTracer {
 public:
  /// At least one triangle; coordinates are finite.
  explicit ReferenceTracer(std::vector<Corners> triangles);

  const std::vector<Corners>& triangles() const { return triangles_; }
  const Box3d& box() const { return nodes_[0].box; }

  /// The first triangle that the ray meets in [t_min, t_max]; of two at the same t, the lower. Origins are within 2^12
  /// diagonals of the mesh.
  ReferenceHit closest_hit(const Ray& ray) const;
  bool any_hit(const Ray& ray) const;

  /// How far p is from the surface, if that is less than `limit`; otherwise `limit`.
  double distance(Vec3d p, double limit = std::numeric_limits<double>::infinity()) const;

 private:
  struct Node {
    Box3d box;
    uint32_t first = 0;  // of the leaf's triangles in order_, or the first of two children, which are neighbours
    uint32_t count = 0;  // triangles of a leaf; 0: an inner node
  };

  void build(uint32_t node, uint32_t begin, uint32_t end, const std::vector<Vec3d>& centres);
  /// Calls visit(triangle) for those whose boxes the ray passes before *t_limit, nearer boxes first, until it returns
  /// false.
  template <class Visit>
  void along(const Ray& ray, const double& t_limit, const Visit& visit) const;

  std::vector<Corners> triangles_;
  std::vector<uint32_t> order_;
  std::vector<Node> nodes_;
  double margin_ = 0;  // added to boxes: more than the triangle test's rounding can move a triangle
};

}  // namespace kd::bench
