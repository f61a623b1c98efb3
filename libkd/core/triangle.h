// Ray and triangle, decided exactly.
//
// The triangle is sheared along the ray into the plane across the ray's axis (Woop, Benthin, Wald, "Watertight
// Ray/Triangle Intersection", JCGT 2013), where the ray is the origin and the signs of three edge functions say whether
// it passes inside. They are evaluated twice:
//   - in float32, which only rejects: each value comes with a proven bound of its error, and two signs that are certain
//     and differ mean a miss;
//   - for what is left, in double, where the sheared coordinates are exact (`core/lattice_ray.h`) and a difference of
//     products computed after Kahan has the exact sign, zero included (Jeannerod, Louvet, Muller, "Further analysis of
//     Kahan's algorithm for the accurate computation of 2x2 determinants", Math. Comp. 2013: error at most 1.5 ulp).
// A zero, a ray through an edge or a vertex, is settled by a rule that is the same for all triangles of the object: the
// ray counts as moved by (e, e^2), e infinitesimal and positive, along the two axes of the plane. So it passes through
// exactly one of the triangles around a shared edge or vertex, and a triangle seen edge-on is missed.
#pragma once

#include <cmath>

#include "core/arithmetic.h"
#include "core/lattice_ray.h"

namespace kd {

/// A triangle as traversal reads it: lattice coordinates, exact in float32, 48 bytes in three 16-byte loads.
struct alignas(16) TriangleVertices {
  Vec3f a;
  uint32_t pad0 = 0;
  Vec3f b;
  uint32_t pad1 = 0;
  Vec3f c;
  uint32_t pad2 = 0;
};

/// Where a ray meets a triangle: distance s along the ray, weights of the vertices b and c.
struct TriangleHit {
  double s;
  double u;
  double v;
};

namespace detail {

/// A vertex relative to the ray, axes exchanged so that z is the ray's. z is its distance s along the ray; x and y are
/// not sheared yet. All three are exact.
struct RelativeVertex {
  float x, y, z;
};

KD_HD KD_INLINE RelativeVertex relative_to(const LatticeRay& ray, Vec3f p) {
  const Vec3f r = p - ray.origin;
  const float along = ray.axis == 0 ? r.x : ray.axis == 1 ? r.y : r.z;
  const float sign = ray.direction[ray.axis];
  return {ray.axis == 0 ? r.z : r.x, ray.axis == 1 ? r.z : r.y, along * sign};
}

/// One edge function, p x q, and a bound of its error. With unit roundoff e = 2^-24 each sheared coordinate is off by
/// at most e of itself, so each product by at most 2e + O(e^2); one rounding of the second product and one of the sum
/// come on top: at most 5e of the products' magnitudes in all, and 8e covers the rounding of the bound.
struct FilteredEdge {
  float value;
  float bound;
};

KD_HD KD_INLINE FilteredEdge filtered_edge(float px, float py, float qx, float qy) {
  const float second = py * qx;
  return {std::fma(px, qy, -second), 0x1p-21f * std::fma(std::fabs(px), std::fabs(qy), std::fabs(second))};
}

/// p x q to 1.5 ulp, so with the exact sign: Kahan's difference of products.
KD_HD KD_INLINE double exact_edge(double px, double py, double qx, double qy) {
  const double second = py * qx;
  const double error = std::fma(py, qx, -second);
  return std::fma(px, qy, -second) - error;
}

/// The sign of p x q (its value is `edge`) for a ray moved by (e, e^2): the value then is
/// edge - e * (q.y - p.y) + e^2 * (q.x - p.x). 0 only for an edge that the ray sees as a point.
KD_HD KD_INLINE int edge_side(double edge, double px, double py, double qx, double qy) {
  if (edge != 0) return edge > 0 ? 1 : -1;
  if (qy != py) return qy < py ? 1 : -1;
  if (qx != px) return qx > px ? 1 : -1;
  return 0;
}

}  // namespace detail

/// Whether the ray, taken over all s, passes through the triangle, and if so where. The decision is exact; s, u and v
/// are good to a few ulp of the largest vertex distance. `s_limit`: hits that are certainly beyond it need not be
/// found.
KD_HD KD_INLINE bool intersect_triangle(const LatticeRay& ray, const TriangleVertices& triangle, float s_limit,
                                        TriangleHit& hit) {
  using namespace detail;
  const RelativeVertex a = relative_to(ray, triangle.a);
  const RelativeVertex b = relative_to(ray, triangle.b);
  const RelativeVertex c = relative_to(ray, triangle.c);
  if (min_of(a.z, b.z, c.z) > s_limit || max_of(a.z, b.z, c.z) < 0) return false;

  const float dx = ray.axis == 0 ? ray.direction.z : ray.direction.x;
  const float dy = ray.axis == 1 ? ray.direction.z : ray.direction.y;
  const float ax = std::fma(-dx, a.z, a.x), ay = std::fma(-dy, a.z, a.y);
  const float bx = std::fma(-dx, b.z, b.x), by = std::fma(-dy, b.z, b.y);
  const float cx = std::fma(-dx, c.z, c.x), cy = std::fma(-dy, c.z, c.y);
  const FilteredEdge fu = filtered_edge(bx, by, cx, cy);
  const FilteredEdge fv = filtered_edge(cx, cy, ax, ay);
  const FilteredEdge fw = filtered_edge(ax, ay, bx, by);
  const bool some_positive = fu.value > fu.bound || fv.value > fv.bound || fw.value > fw.bound;
  const bool some_negative = fu.value < -fu.bound || fv.value < -fv.bound || fw.value < -fw.bound;
  if (some_positive && some_negative) return false;

  const auto shear = [](float slope, float z, float x) {
    return static_cast<double>(x) - static_cast<double>(slope) * static_cast<double>(z);
  };
  const double eax = shear(dx, a.z, a.x), eay = shear(dy, a.z, a.y);
  const double ebx = shear(dx, b.z, b.x), eby = shear(dy, b.z, b.y);
  const double ecx = shear(dx, c.z, c.x), ecy = shear(dy, c.z, c.y);
  const double u = exact_edge(ebx, eby, ecx, ecy);
  const double v = exact_edge(ecx, ecy, eax, eay);
  const double w = exact_edge(eax, eay, ebx, eby);
  const int side = edge_side(u, ebx, eby, ecx, ecy);
  if (side == 0 || edge_side(v, ecx, ecy, eax, eay) != side || edge_side(w, eax, eay, ebx, eby) != side) return false;

  // None of the three is on the other side of 0, and not all are 0: that is a triangle seen edge-on, missed above.
  const double sum = u + v + w;
  hit = {(u * a.z + v * b.z + w * c.z) / sum, v / sum, w / sum};
  return true;
}

/// The test as traversal takes it; for benchmarks another may stand in its place (core/float_triangle.h).
struct ExactTest {
  using Hit = TriangleHit;
  static constexpr bool kExact = true;
  const LatticeRay& ray;

  KD_HD KD_INLINE bool intersect(const TriangleVertices& triangle, float s_limit, TriangleHit& hit) const {
    return intersect_triangle(ray, triangle, s_limit, hit);
  }
};

}  // namespace kd
