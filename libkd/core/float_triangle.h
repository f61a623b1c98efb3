// The usual triangle tests, in float32: baselines that the exact one (core/triangle.h) is measured against, and nothing
// that a render runs. They leak: a ray at an edge or a vertex may miss all triangles around it or meet several, and how
// far off a hit is depends on the triangle and the ray. Written to be as fast as they can be: fused where the published
// form does not forbid it, and divided only for hits.
//
// Both take rays that were rounded to float32, not snapped (render/float_ray.h), and any vertices in lattice space. A
// test says whether the ray meets the triangle within [0, s_limit], and where.
#pragma once

#include <cmath>

#include "core/triangle.h"

namespace kd {

/// As TriangleHit, in float32.
struct FloatHit {
  float s = 0;
  float u = 0;
  float v = 0;
};

namespace detail {

KD_HD KD_INLINE Vec3f fused_cross(Vec3f a, Vec3f b) {
  return {std::fma(a.y, b.z, -(a.z * b.y)), std::fma(a.z, b.x, -(a.x * b.z)), std::fma(a.x, b.y, -(a.y * b.x))};
}

/// A vertex relative to the ray, axes exchanged so that z is the ray's, and z its distance s along the ray.
KD_HD KD_INLINE Vec3f relative_to(const LatticeRay& ray, Vec3f p) {
  const Vec3f r = p - ray.origin;
  return {ray.axis == 0 ? r.z : r.x, ray.axis == 1 ? r.z : r.y, r[ray.axis] * ray.direction[ray.axis]};
}

}  // namespace detail

/// Moller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", JGT 1997, both sides of the triangle.
struct MollerTrumbore {
  KD_HD KD_INLINE static bool intersect(const LatticeRay& ray, const TriangleVertices& triangle, float s_limit,
                                        FloatHit& hit) {
    using namespace detail;
    const Vec3f ab = triangle.b - triangle.a, ac = triangle.c - triangle.a;
    const Vec3f p = fused_cross(ray.direction, ac);
    const float det = fused_dot(ab, p);
    const float size = std::fabs(det), side = std::copysign(1.0f, det);
    const Vec3f from_a = (ray.origin - triangle.a) * Vec3f{side, side, side};
    const float u = fused_dot(from_a, p);
    if (!(u >= 0 && u <= size)) return false;
    const Vec3f q = fused_cross(from_a, ab);
    const float v = fused_dot(ray.direction, q);
    if (!(v >= 0 && u + v <= size)) return false;
    const float s = fused_dot(ac, q);
    if (!(s >= 0 && s <= s_limit * size && size > 0)) return false;
    const float inverse = 1 / size;
    hit = {s * inverse, u * inverse, v * inverse};
    return true;
  }
};

/// Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2013, both sides, with its fallback to double
/// where an edge function is zero. The ray's largest direction component is 1 or -1, so the shear needs no division.
/// The edge functions are not fused: only then does an edge have the same value, negated, for the triangle on its other
/// side.
struct Woop {
  KD_HD KD_INLINE static bool intersect(const LatticeRay& ray, const TriangleVertices& triangle, float s_limit,
                                        FloatHit& hit) {
    using namespace detail;
    const Vec3f a = relative_to(ray, triangle.a);
    const Vec3f b = relative_to(ray, triangle.b);
    const Vec3f c = relative_to(ray, triangle.c);
    const float dx = ray.axis == 0 ? ray.direction.z : ray.direction.x;
    const float dy = ray.axis == 1 ? ray.direction.z : ray.direction.y;
    const float ax = std::fma(-dx, a.z, a.x), ay = std::fma(-dy, a.z, a.y);
    const float bx = std::fma(-dx, b.z, b.x), by = std::fma(-dy, b.z, b.y);
    const float cx = std::fma(-dx, c.z, c.x), cy = std::fma(-dy, c.z, c.y);
    float u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
    if (u == 0 || v == 0 || w == 0) {
      const auto edge = [](float px, float py, float qx, float qy) {
        return static_cast<float>(static_cast<double>(px) * qy - static_cast<double>(py) * qx);
      };
      u = edge(cx, cy, bx, by);
      v = edge(ax, ay, cx, cy);
      w = edge(bx, by, ax, ay);
    }
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
    const float det = u + v + w;
    if (det == 0) return false;
    const float side = std::copysign(1.0f, det), size = std::fabs(det);
    const float s = std::fma(u, a.z, std::fma(v, b.z, w * c.z)) * side;
    if (!(s >= 0 && s <= s_limit * size)) return false;
    const float inverse = 1 / det;
    hit = {s * std::fabs(inverse), v * inverse, w * inverse};
    return true;
  }
};

/// One of these as the policy that traversal takes.
template <class Method>
struct FloatTest {
  static constexpr bool kExact = false;
  using Distance = float;
  const LatticeRay& ray;

  template <RayMode mode, class Counter>
  KD_HD KD_INLINE bool meets(const TriangleVertices& triangle, float s_limit, float& s, Counter&) const {
    FloatHit hit;
    if (!Method::intersect(ray, triangle, s_limit, hit)) return false;
    s = hit.s;
    return true;
  }
  /// Of a triangle that the ray meets.
  KD_HD KD_INLINE FloatHit locate(const TriangleVertices& triangle) const {
    FloatHit hit;
    Method::intersect(ray, triangle, 1e30f, hit);
    return hit;
  }
};

using MollerTrumboreTest = FloatTest<MollerTrumbore>;
using WoopTest = FloatTest<Woop>;

}  // namespace kd
