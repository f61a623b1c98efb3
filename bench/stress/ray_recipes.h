// How rays are made that lose hits: a function each, of the case, the ray's number and random numbers.
#pragma once

#include "render/stages/surface.h"
#include "stress/case_view.h"
#include "stress/query.h"
#include "stress/random.h"

namespace kd::stress {

namespace detail {

KD_HD KD_INLINE Vec3d vertex_of(const CaseView& c, uint32_t i) { return vec_cast<double>(c.vertices[i]); }
KD_HD KD_INLINE OracleTriangle some_triangle(const CaseView& c, Random& random) {
  return c.oracle.triangles[random.below(c.oracle.triangle_count)];
}

/// Vertices, edge midpoints and interiors of faces, one after the other.
KD_HD inline Vec3d feature(const CaseView& c, RayClass ray_class, uint64_t index, Random& random) {
  const OracleTriangle& t = c.oracle.triangles[index / 3 % c.oracle.triangle_count];
  const Vec3d p = vec_cast<double>(t.a), q = vec_cast<double>(t.b), r = vec_cast<double>(t.c);
  switch (ray_class) {
    case RayClass::vertices:
      return vertex_of(c, static_cast<uint32_t>(index % c.vertex_count));
    case RayClass::edges: {
      const uint64_t side = index % 3;
      return ((side == 0 ? p : q) + (side == 1 ? r : side == 0 ? q : p)) * 0.5;
    }
    default: {
      double u = random.unit(), v = random.unit();
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      return p + (q - p) * u + (r - p) * v;
    }
  }
}

KD_HD inline Vec3d some_feature(const CaseView& c, uint64_t index, Random& random) {
  const auto kind = static_cast<RayClass>(random.below(3));
  return feature(c, kind, index, random);
}

KD_HD KD_INLINE Vec3d some_point(const CaseView& c, Random& random, double size) {
  return Vec3d{0.5, 0.5, 0.5} * c.top() + random.vector(0.5 * size * c.top());
}

/// Makes some component 1 or -1.
KD_HD KD_INLINE Vec3d with_some_axis(Vec3d d, Random& random) {
  const auto axis = static_cast<int>(random.below(3));
  d.set(axis, random.sign());
  return d;
}
KD_HD KD_INLINE Vec3d some_direction(Random& random) { return with_some_axis(random.vector(1), random); }

/// Whether everything that the ray meets lies ahead of it.
KD_HD KD_INLINE bool starts_outside(const CaseView& c, Vec3d origin) {
  const double margin = 1, top = c.top();
  const auto out = [&](double x) { return x < -margin || x > top + margin; };
  return out(origin.x) || out(origin.y) || out(origin.z);
}

KD_HD inline void exact_slopes(const CaseView& c, uint64_t index, Random& random, Query& q) {
  const Vec3d target = feature(c, random.chance(0.5) ? RayClass::vertices : RayClass::edges, index, random);
  const double scale = static_cast<double>(1u << random.below(5));
  const auto slope = [&] { return random.chance(0.3) ? 0.0 : std::rint(random.real(-scale, scale)) / scale; };
  const double x = slope(), y = slope();
  const Vec3d d = with_some_axis({x, y, slope()}, random);
  q.direction = d;
  q.origin = target - d * (std::rint(random.real(0, 2 * c.top())) * scale);
}

KD_HD inline void in_a_split_plane(const CaseView& c, uint64_t index, Random& random, Query& q) {
  uint32_t at = random.below(c.node_count);
  for (uint32_t tries = 0; is_leaf(c.object.nodes[at]) && tries < 64; ++tries) at = (at + 1) % c.node_count;
  Vec3d target = some_feature(c, index, random);
  Vec3d d = some_direction(random);
  const Node node = c.object.nodes[at];
  const int axis = is_leaf(node) ? static_cast<int>(random.below(3)) : split_axis(node);
  if (!is_leaf(node)) target.set(axis, static_cast<double>(split_plane(node)));
  d.set(axis, 0);
  if (random.chance(0.2)) d.set((axis + 1) % 3, 0);
  if (d == Vec3d{0, 0, 0}) d.set((axis + 2) % 3, 1);
  q = {target - d * (random.chance(0.3) ? random.real(0, 1) * c.top() : 3 * c.top()), d};
}

KD_HD inline void through_lattice_points(const CaseView& c, uint64_t index, Random& random, Query& q) {
  const int axis = static_cast<int>(random.below(3));
  const Vec3d p = vertex_of(c, static_cast<uint32_t>(index % c.vertex_count));
  const Vec3d other = vertex_of(c, random.below(c.vertex_count));
  Vec3d o = p, d{0, 0, 0};
  if (random.chance(0.5)) o.set((axis + 1) % 3, other[(axis + 1) % 3]);
  if (random.chance(0.1)) o.set((axis + 2) % 3, o[(axis + 2) % 3] + 0.5);
  d.set(axis, random.either_magnitude(-3, 3));
  const double inside = std::rint(random.real(0, c.top()));
  o.set(axis, random.chance(0.7) ? (d[axis] > 0 ? -2 * c.top() : 3 * c.top()) : inside);
  q = {o, d};
}

KD_HD inline void in_a_triangles_plane(const CaseView& c, Random& random, Query& q) {
  const OracleTriangle t = some_triangle(c, random);
  const Vec3d a = vec_cast<double>(t.a), ab = vec_cast<double>(t.b) - a, ac = vec_cast<double>(t.c) - a;
  const double u = random.real(-1, 1), v = random.real(-1, 1);
  Vec3d d = normalised(ab * u + ac * v);
  if (d == Vec3d{0, 0, 0}) d = {1, 0, 0};
  const double x = random.unit(), y = random.unit();
  Vec3d target = a + ab * x + ac * y;
  if (random.chance(0.6)) {  // off it, by less and less
    const Vec3d n = normalised(cross(ab, ac));
    d = d + n * random.either_magnitude(-12, -3);
    if (random.chance(0.5)) target = target + n * random.either_magnitude(-8, 0);
  }
  q = {target - d * ((random.chance(0.5) ? 2.5 : random.unit()) * c.top()), d};
}

KD_HD inline void from_vertex_to_vertex(const CaseView& c, Random& random, Query& q) {
  const OracleTriangle t = some_triangle(c, random);
  const Vec3d a = vec_cast<double>(t.a);
  const bool edge = random.chance(0.6);
  const Vec3d b = edge ? vec_cast<double>(t.b) : vertex_of(c, random.below(c.vertex_count));
  Vec3d d = b - a;
  if (d == Vec3d{0, 0, 0}) d = {0, 0, 1};
  q = {random.chance(0.5) ? a : a - d * std::rint(random.magnitude(0, 3)), d};
  if (random.chance(0.3)) q.direction = d * random.magnitude(-12, 12);
}

/// The first rays go from one point to every vertex and to the middle of every edge of every triangle, the next ones
/// from another point, and so on.
KD_HD inline void from_inside(const CaseView& c, uint64_t seed, uint64_t index, Random& random, Query& q) {
  const uint64_t features = c.vertex_count + uint64_t{3} * c.oracle.triangle_count;
  Random of_origin(seed, index / features);
  const uint64_t i = index % features;
  q.origin = c.traits.inside_point + of_origin.vector(1) * c.traits.inside_size;
  q.direction = (i < c.vertex_count ? feature(c, RayClass::vertices, i, random)
                                    : feature(c, RayClass::edges, i - c.vertex_count, random)) -
                q.origin;
  q.demand = Demand::hit;
}

/// Takes the query through a frame and back, as the renderer does with a scene's rays.
KD_HD inline void through_frame(const CaseView& c, uint32_t placement, Query& q) {
  const render::InstanceView& instance = c.placements[placement];
  const Vec3d o = instance.to_scene.apply_point(q.origin), d = instance.to_scene.apply_vector(q.direction);
  q.origin = instance.to_lattice.apply_point(o);
  q.direction = instance.to_lattice.apply_vector(d);
}

KD_HD inline void as_record(const CaseView& c, Query& q) {
  const render::InstanceView& instance = c.placements[0];
  const Vec3f o = vec_cast<float>(instance.to_scene.apply_point(q.origin));
  const Vec3f d = vec_cast<float>(normalised(instance.to_scene.apply_vector(q.direction)));
  q.origin = instance.to_lattice.apply_point(vec_cast<double>(o));
  q.direction = instance.to_lattice.apply_vector(vec_cast<double>(d));
}

/// A direction of scene space on the lit side of a surface, down to the very horizon.
KD_HD inline Vec3d to_some_light(Vec3d normal, double lowest, Random& random) {
  const Vec3d across = normalised(cross(normal, normalised(random.vector(1))));
  return across + normal * max_of(lowest, random.chance(0.5) ? random.unit() : random.magnitude(-9, -1));
}

/// Turns `q` into the shadow ray of what it hits, placed by `placement`, as the renderer's own stages make it; where it
/// hits nothing it stays what it is.
KD_HD inline void cast_shadow(const CaseView& c, uint32_t placement, double lowest, Random& random, Query& q) {
  LatticeRay ray;
  if (!snap_ray(q.origin, q.direction, 0, 1e300, c.object.bits, ray)) return;
  NoCounter counter;
  const uint32_t triangle = traverse<RayMode::closest>(c.object, ray, ray.s_max, kNoTriangle, counter);
  if (triangle == kNoTriangle) return;
  TriangleHit hit{};
  intersect_triangle(ray, c.object.triangles[triangle], hit);
  const render::InstanceView& instance = c.placements[placement];
  const Vec3d view = instance.to_scene.apply_vector(q.direction);
  const render::SurfaceHit surface_hit{ray.t_at(hit.s), hit.u, hit.v, placement, triangle};
  const render::Surface surface = render::surface_at(c.scene(), surface_hit, view);
  const Vec3d light = to_some_light(surface.geometric, lowest, random);
  if (!(dot(surface.geometric, light) > 0)) return;
  q.origin = instance.to_lattice.apply_point(surface.shadow_origin);
  q.direction = instance.to_lattice.apply_vector(light);
  q.excluded = triangle;
  q.demand = c.traits.convex ? Demand::lit : Demand::lifted;
}

KD_HD inline Query random_query(const CaseView& c, RayClass ray_class, uint64_t index, Random& random) {
  Query q;
  const Vec3d target =
      ray_class <= RayClass::faces ? feature(c, ray_class, index, random) : some_feature(c, index, random);
  q.origin = random.chance(0.25) ? some_point(c, random, 1) : some_point(c, random, 5);
  q.direction = target - q.origin;
  return q;
}

}  // namespace detail

}  // namespace kd::stress
