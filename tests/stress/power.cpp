// That the suite can fail: the same rays and the same judge, with tracers that are known to be wrong. What comes out is
// printed as a table, plain float tests beside ours.
#include <algorithm>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "stress/check.h"
#include "stress/stress_case.h"

using namespace kd;
using namespace kd::stress;

namespace {

/// A tracer that looks at every triangle and decides by Test::inside; distances and weights are right, so that only
/// decisions are judged.
template <class Test>
struct PlainTracer {
  static constexpr bool kExact = true;  // of distances
  static bool meets(const CaseView& c, const LatticeRay& ray, uint32_t triangle, TriangleHit& hit) {
    const TriangleVertices& t = c.object.triangles[triangle];
    if (!Test::inside(ray, t)) return false;
    ExactRay exact;
    REQUIRE(to_integers(ray, c.object.bits, exact));
    const Crossing crossing = cross_triangle(exact, c.oracle.triangle(triangle));
    hit = crossing.met ? TriangleHit{crossing.s, crossing.v, crossing.w} : plane_hit(ray, t);
    return true;
  }
  template <class Counter>
  static uint32_t closest(const CaseView& c, const LatticeRay& ray, uint32_t excluded, Counter&) {
    stress::detail::Rank best;
    for_each_hit(c, ray, excluded, [&](const stress::detail::Rank& rank) {
      if (rank.s_least < best.s_least) best = rank;
    });
    return best.triangle;
  }
  static uint32_t any(const CaseView& c, const LatticeRay& ray, uint32_t excluded) {
    uint32_t some = kNoTriangle;
    for_each_hit(c, ray, excluded, [&](const stress::detail::Rank& rank) { some = std::min(some, rank.triangle); });
    return some;
  }

 private:
  template <class Visit>
  static void for_each_hit(const CaseView& c, const LatticeRay& ray, uint32_t excluded, const Visit& visit) {
    for (uint32_t i = 0; i < c.oracle.triangle_count; ++i) {
      TriangleHit hit{};
      if (i == excluded || !meets(c, ray, i, hit)) continue;
      if (hit.s >= ray.s_min && hit.s <= ray.s_max) visit(stress::detail::Rank{hit.s, hit.s, i});
    }
  }
  static TriangleHit plane_hit(const LatticeRay& ray, const TriangleVertices& t) {
    const Vec3d a = vec_cast<double>(t.a), o = vec_cast<double>(ray.origin), d = vec_cast<double>(ray.direction);
    const Vec3d n = cross(vec_cast<double>(t.b) - a, vec_cast<double>(t.c) - a);
    const double slope = dot(n, d);
    return {slope != 0 ? dot(n, a - o) / slope : 0, 0, 0};
  }
};

/// Möller, Trumbore, "Fast, minimum storage ray/triangle intersection", JGT 1997, in float32.
struct MoellerTrumbore {
  static bool inside(const LatticeRay& ray, const TriangleVertices& t) {
    const Vec3f ab = t.b - t.a, ac = t.c - t.a, p = cross(ray.direction, ac);
    const float det = dot(ab, p);
    if (det == 0) return false;
    const Vec3f r = ray.origin - t.a, q = cross(r, ab);
    const float u = dot(r, p) / det, v = dot(ray.direction, q) / det;
    return u >= 0 && v >= 0 && u + v <= 1;
  }
};

/// Plücker coordinates of the edges, in float32.
struct Pluecker {
  static bool inside(const LatticeRay& ray, const TriangleVertices& t) {
    const auto side = [&](Vec3f p, Vec3f q) { return dot(ray.direction, cross(p - ray.origin, q - ray.origin)); };
    const float u = side(t.b, t.c), v = side(t.c, t.a), w = side(t.a, t.b);
    return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
  }
};

/// The watertight test of core/triangle.h's source, as published: edges count on both sides.
struct Woop {
  static bool inside(const LatticeRay& ray, const TriangleVertices& t) {
    const int k = ray.axis, x = k == 0 ? 2 : 0, y = k == 1 ? 2 : 1;
    const float sign = ray.direction[k];
    const auto shear = [&](Vec3f p, int axis) {
      const Vec3f r = p - ray.origin;
      return r[axis] - ray.direction[axis] * sign * r[k];
    };
    const float ax = shear(t.a, x), ay = shear(t.a, y), bx = shear(t.b, x), by = shear(t.b, y);
    const float cx = shear(t.c, x), cy = shear(t.c, y);
    float u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
    if (u == 0 || v == 0 || w == 0) {
      const auto product = [](float p, float q) { return double{p} * double{q}; };
      u = static_cast<float>(product(cx, by) - product(cy, bx));
      v = static_cast<float>(product(ax, cy) - product(ay, cx));
      w = static_cast<float>(product(bx, ay) - product(by, ax));
    }
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
    return u + v + w != 0;
  }
};

/// The product, but for a leaf's worth of triangles that traversal loses.
struct LosesSome : ProductTracer {
  template <class Counter>
  static uint32_t closest(const CaseView& c, const LatticeRay& ray, uint32_t excluded, Counter& counter) {
    const uint32_t found = ProductTracer::closest(c, ray, excluded, counter);
    return found != kNoTriangle && found % 64 == 5 ? kNoTriangle : found;
  }
};

/// The product, but for a nearest hit that is just some hit.
struct NotNearest : ProductTracer {
  template <class Counter>
  static uint32_t closest(const CaseView& c, const LatticeRay& ray, uint32_t excluded, Counter& counter) {
    const uint32_t found = ProductTracer::closest(c, ray, excluded, counter);
    const uint32_t second = found == kNoTriangle ? found : ProductTracer::closest(c, ray, found, counter);
    return second == kNoTriangle ? found : second;
  }
};

/// The product, but for shadow rays that forget where they start.
struct ShadowsItself : ProductTracer {
  static uint32_t any(const CaseView& c, const LatticeRay& ray, uint32_t excluded) {
    return excluded != kNoTriangle ? excluded : ProductTracer::any(c, ray, excluded);
  }
};

template <class Tracer>
Tally judge(const char* name, std::initializer_list<RayClass> classes, uint64_t rays = 4000) {
  Tally tally;
  for (const char* mesh : {"small-ball", "tetrahedron", "stairs"}) {
    const auto rows = shape_rows();
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const ShapeRow& r) { return r.name == mesh; });
    const auto c = make_case(*row, 21);
    REQUIRE(c);
    const HostCase host(*c);
    for (const RayClass ray_class : classes) {
      if (ray_class == RayClass::inside && !row->inside) continue;
      for (uint64_t i = 0; i < rays; ++i)
        check_query<Tracer>(host.view(), make_query(host.view(), ray_class, 3, i), i % 8 == 0, tally);
    }
  }
  MESSAGE(fmt::format("{:>18}: {} rays, {} misses, {} double counts, {} mismatches", name, tally[kRays], tally[kMisses],
                      tally[kDoubleCounts], tally[kMismatches]));
  CHECK(tally[kRays] > rays);
  return tally;
}

constexpr std::initializer_list<RayClass> kAimed{RayClass::vertices, RayClass::edges,  RayClass::exact,
                                                 RayClass::along,    RayClass::inside, RayClass::grid};

}  // namespace

TEST_CASE("stress: plain float tests fail, each in its own way; ours does not") {
  const Tally moeller = judge<PlainTracer<MoellerTrumbore>>("Moeller-Trumbore", kAimed, 1500);
  CHECK(moeller[kMisses] > 100);
  CHECK(moeller[kDoubleCounts] > 100);
  const Tally pluecker = judge<PlainTracer<Pluecker>>("Pluecker", kAimed, 1500);
  CHECK(pluecker.faults() > 100);
  const Tally woop = judge<PlainTracer<Woop>>("Woop", kAimed, 1500);
  CHECK(woop[kDoubleCounts] > 100);
  CHECK(woop[kMisses] < woop[kDoubleCounts]);
  CHECK(judge<ProductTracer>("ours", kAimed, 1500).faults() == 0);
}

TEST_CASE("stress: a traversal that loses hits, finds others or shadows itself is found out") {
  const auto lost = judge<LosesSome>("loses some", kAimed);
  CHECK(lost[kMisses] > 100);
  CHECK(lost[kDoubleCounts] == 0);
  CHECK(lost[kMismatches] == 0);
  const auto far = judge<NotNearest>("not the nearest", kAimed);
  CHECK(far[kMisses] == 0);
  CHECK(far[kMismatches] > 1000);
  const auto own = judge<ShadowsItself>("shadows itself", {RayClass::shadow});
  CHECK(own[kMisses] == 0);
  CHECK(own[kMismatches] > 1000);
}

TEST_CASE("stress: a ray that was moved too far, or off its grids, is found out") {
  const auto c = make_case(shape_rows()[2], 21);
  REQUIRE(c);
  const HostCase host(*c);
  Query q = make_query(host.view(), RayClass::faces, 1, 1);
  LatticeRay ray;
  REQUIRE(snap_ray(q.origin, q.direction, q.t_min, q.t_max, 21, ray));
  q = {{1000, 1000, 1000}, {1, 0.25, 0.125}};
  REQUIRE(snap_ray(q.origin, q.direction, 0, 1e300, 21, ray));
  Tally tally;
  CHECK(stress::detail::judge_displacement(host.view(), q, ray, tally) == Fault::none);
  CHECK(tally.moved_near == 0);
  ray.origin.y += 0.125f;  // a grid step at 21 bits
  CHECK(stress::detail::judge_displacement(host.view(), q, ray, tally) == Fault::displaced);
  CHECK(tally.moved_near == doctest::Approx(1));
  ExactRay exact;
  CHECK(to_integers(ray, 21, exact));
  ray.origin.y += 0.03125f;
  CHECK_FALSE(to_integers(ray, 21, exact));
}
