// Ray and triangle, decided exactly.
//
// The triangle is sheared along the ray into the plane across the ray's axis (Woop, Benthin, Wald, "Watertight
// Ray/Triangle Intersection", JCGT 2013), where the ray is the origin and the signs of three edge functions say whether
// it passes inside. They are evaluated twice:
//   - in float32, with a proven bound of their error: three signs that are certain decide, by whether they differ;
//   - for what is left, and for a hit's distance, in double, where the sheared coordinates are exact
//     (`core/lattice_ray.h`) and a difference of products computed after Kahan has the exact sign, zero included
//     (Jeannerod, Louvet, Muller, "Further analysis of Kahan's algorithm for the accurate computation of 2x2
//     determinants", Math. Comp. 2013: error at most 1.5 ulp).
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

/// What traversal and the triangle test count when asked to; `NoCounter` compiles to nothing.
struct NoCounter {
  KD_HD KD_INLINE void node() {}
  KD_HD KD_INLINE void leaf() {}
  KD_HD KD_INLINE void triangle() {}
  KD_HD KD_INLINE void evaluated_in_double() {}  // a triangle that the filter could not reject
};

/// Where a ray meets a triangle: distance s along the ray, weights of the vertices b and c.
struct TriangleHit {
  double s;
  double u;
  double v;
};

namespace detail {

/// p x q to 1.5 ulp, so with the exact sign: Kahan's difference of products.
template <class Double>
KD_HD KD_INLINE Double exact_edge(Double px, Double py, Double qx, Double qy) {
  using std::fma;
  const Double second = py * qx;
  const Double error = fma(py, qx, -second);
  return fma(px, qy, -second) - error;
}

/// The sign of p x q (its value is `edge`) for a ray moved by (e, e^2): the value then is
/// edge - e * (q.y - p.y) + e^2 * (q.x - p.x). 0 only for an edge that the ray sees as a point.
KD_HD KD_INLINE int edge_side(double edge, double px, double py, double qx, double qy) {
  if (edge != 0) return edge > 0 ? 1 : -1;
  if (qy != py) return qy < py ? 1 : -1;
  if (qx != px) return qx > px ? 1 : -1;
  return 0;
}

/// A vertex relative to the ray and sheared along it, so that the ray is x = y = 0; `along` is its coordinate on the
/// ray's axis, not yet turned into a distance by the direction's sign.
template <class T, class Real>
struct Sheared {
  T x, y;
  Real along;
};

/// The three edge functions, exact in sign: each the weight of the vertex across from its edge.
template <class Double, class Real>
struct Weights {
  Sheared<Double, Real> a, b, c;
  Double u, v, w;

  KD_HD KD_INLINE Double sum() const { return u + v + w; }
  KD_HD KD_INLINE Double inverse_sum() const { return reciprocal(sum()); }
  KD_HD KD_INLINE Double distance_times_sum(Real sign) const {
    using std::fma;
    return fma(u, Double(a.along), fma(v, Double(b.along), w * Double(c.along))) * Double(sign);
  }
  KD_HD KD_INLINE bool touches() const { return u == 0 || v == 0 || w == 0; }
  KD_HD KD_INLINE double extent() const {
    return 1 + std::fabs(static_cast<double>(a.along)) + std::fabs(static_cast<double>(b.along)) +
           std::fabs(static_cast<double>(c.along));
  }
  KD_HD KD_INLINE bool all_on_one_side() const {
    const int side = edge_side(u, b.x, b.y, c.x, c.y);
    return side != 0 && edge_side(v, c.x, c.y, a.x, a.y) == side && edge_side(w, a.x, a.y, b.x, b.y) == side;
  }
};

/// The plane across a ray's axis, and what float32 can tell in it. Real is float, or a packet's for rays that share an
/// axis (core/packet.h).
template <class Real>
struct Shear {
  Vec3<Real> origin;
  Real slope_x, slope_y;  // what x and y lose for each step along the axis, negated
  bool along_x, along_y;  // the axis; where both are false it is z

  /// In float32 each sheared coordinate is off by one rounding of itself, in double it is exact: v - origin is exact in
  /// float32, and 24 bits of slope times 24 bits of distance fit.
  template <class T>
  KD_HD KD_INLINE Sheared<T, Real> apply(Vec3f p) const {
    const Vec3<Real> r{p.x - origin.x, p.y - origin.y, p.z - origin.z};
    const Real along = along_x ? r.x : along_y ? r.y : r.z;
    const T x = along_x ? r.z : r.x, y = along_y ? r.z : r.y;
    using std::fma;
    return {fma(static_cast<T>(slope_x), static_cast<T>(along), x),
            fma(static_cast<T>(slope_y), static_cast<T>(along), y), along};
  }

  struct Decision {
    Truth<Real> certain;
    Truth<Real> apart;  // the edge functions have not all one sign: the ray passes beside the triangle
  };

  /// In float32. With unit roundoff e = 2^-24, an edge function X - T, both products of two sheared coordinates, has X
  /// off by 2e |X| and T by 3e |T| before they are subtracted and once more rounded. Were the sign of the result wrong,
  /// |X| would be at most |T|, to terms of e, and the result at most 5e |T|. So 8e of the largest T bounds all three.
  KD_HD KD_INLINE Decision filter(const TriangleVertices& triangle) const {
    using std::fabs, std::fma;
    const auto a = apply<Real>(triangle.a), b = apply<Real>(triangle.b), c = apply<Real>(triangle.c);
    const Real tu = b.y * c.x, tv = c.y * a.x, tw = a.y * b.x;
    const Real u = fma(b.x, c.y, -tu), v = fma(c.x, a.y, -tv), w = fma(a.x, b.y, -tw);
    const Real bound = 0x1p-21f * largest_of(largest_of(fabs(tu), fabs(tv)), fabs(tw));
    const Real least = least_of(least_of(fabs(u), fabs(v)), fabs(w));
    return {least > bound, signs_differ(u, v, w)};
  }

  template <class Double>
  KD_HD KD_INLINE Weights<Double, Real> weigh(const TriangleVertices& triangle) const {
    const auto a = apply<Double>(triangle.a), b = apply<Double>(triangle.b), c = apply<Double>(triangle.c);
    return {a, b, c, exact_edge(b.x, b.y, c.x, c.y), exact_edge(c.x, c.y, a.x, a.y), exact_edge(a.x, a.y, b.x, b.y)};
  }
};

/// Of a ray, or of a packet's whose axis is `axis`.
template <class LatticeRayType>
KD_HD KD_INLINE auto shear_along(const LatticeRayType& ray, int axis) {
  Shear<typename LatticeRayType::Float> shear;
  const auto sign = ray.direction[axis];
  shear.origin = ray.origin;
  shear.along_x = axis == 0;
  shear.along_y = axis == 1;
  shear.slope_x = -sign * (shear.along_x ? ray.direction.z : ray.direction.x);
  shear.slope_y = -sign * (shear.along_y ? ray.direction.z : ray.direction.y);
  return shear;
}

}  // namespace detail

/// One ray against any triangles of its object. The decisions are exact. Traversal takes the test as a policy, so that
/// benchmarks can put another in its place (core/float_triangle.h).
class ExactTest {
 public:
  static constexpr bool kExact = true;
  using Distance = double;

  KD_HD KD_INLINE explicit ExactTest(const LatticeRay& ray)
      : ExactTest(detail::shear_along(ray, ray.axis), ray.direction[ray.axis]) {}
  /// Of a ray that is kept as what the test needs of it; the sign is the direction's along the axis.
  KD_HD KD_INLINE ExactTest(const detail::Shear<float>& shear, float sign) : shear_(shear), sign_(sign) {}

  /// Whether the ray, taken over all s, passes through the triangle, and then its distance s, good to 2^-50 of the
  /// largest vertex distance. Triangles around an edge or a vertex that the ray passes through are at one distance: for
  /// the closest hit those it leaves by, as their corners are wound, are put farther by more than the rounding, so that
  /// a body is entered before it is left. (The limit on s is for tests that gain by it, core/float_triangle.h.)
  template <RayMode mode, class Counter>
  KD_HD KD_INLINE bool meets(const TriangleVertices& triangle, float, double& s, Counter& counter) const {
    const Decision decision = filter(triangle);
    if (decision.certain && decision.apart) return false;
    counter.evaluated_in_double();
    return meets_in_double<mode>(triangle, decision.certain, s);
  }

  using Decision = detail::Shear<float>::Decision;

  /// What float32 can tell: `certain` and `apart` is a miss.
  KD_HD KD_INLINE Decision filter(const TriangleVertices& triangle) const { return shear_.filter(triangle); }

  /// `meets` for a triangle that the filter does not reject, and whether it was certain.
  template <RayMode mode>
  KD_HD KD_INLINE bool meets_in_double(const TriangleVertices& triangle, bool certain, double& s) const {
    const Weights w = weigh(triangle);
    if (!certain && !w.all_on_one_side()) return false;
    // None of the three is on the other side of 0, and not all are 0: that is a triangle seen edge-on, and missed.
    s = w.distance_times_sum(sign_) * w.inverse_sum();
    if constexpr (mode == RayMode::closest) {
      const bool behind = s < 0;  // and stays there
      if (!certain && !behind && w.touches() && leaves_by(w)) s += kLeavingLater * w.extent();
    }
    return true;
  }

  /// Where the ray meets a triangle that it passes through; s, u and v are good to a few ulp.
  KD_HD KD_INLINE TriangleHit locate(const TriangleVertices& triangle) const {
    const Weights w = weigh(triangle);
    const double inverse = w.inverse_sum();
    return {w.distance_times_sum(sign_) * inverse, w.v * inverse, w.w * inverse};
  }

 protected:
  using Weights = detail::Weights<double, float>;

  KD_HD KD_INLINE Weights weigh(const TriangleVertices& triangle) const { return shear_.weigh<double>(triangle); }

  /// Whether the triangle's normal, right-handed by its corners, points along the ray. For two of the three axes x and
  /// y are a left-handed pair.
  KD_HD KD_INLINE bool leaves_by(const Weights& w) const {
    return (w.sum() * sign_ > 0) != (shear_.along_x || shear_.along_y);
  }

 private:
  /// By how much a face that the ray leaves by comes later, of its vertices' distances: 16 times the rounding of s.
  static constexpr double kLeavingLater = 0x1p-46;

  detail::Shear<float> shear_;
  float sign_;  // of the direction along its axis
};

/// Of the triangles that ExactTest meets, those whose front the ray meets, where their corners are wound
/// counterclockwise: its direction is against their normal. As exact: three weights of one sign have a sum of that
/// sign.
class FrontTest : public ExactTest {
 public:
  using ExactTest::ExactTest;

  template <RayMode mode, class Counter>
  KD_HD KD_INLINE bool meets(const TriangleVertices& triangle, float s_limit, double& s, Counter& counter) const {
    return ExactTest::meets<mode>(triangle, s_limit, s, counter) && !leaves_by(weigh(triangle));
  }
};

/// ExactTest::meets and, if so, ExactTest::locate.
KD_HD KD_INLINE bool intersect_triangle(const LatticeRay& ray, const TriangleVertices& triangle, TriangleHit& hit) {
  const ExactTest test(ray);
  NoCounter counter;
  double s;
  if (!test.meets<RayMode::any>(triangle, 0, s, counter)) return false;
  hit = test.locate(triangle);
  return true;
}

}  // namespace kd
