// The float baselines: their ray, the tests against extended precision, and both in the traversal kernel.
#include <doctest/doctest.h>

#include <algorithm>

#include "core/float_triangle.h"
#include "render/cpu_backend.h"
#include "render/float_ray.h"
#include "worlds.h"

using namespace kd;
using namespace kd::test;

namespace {

using Vec3l = Vec3<long double>;

/// Where a ray as it was rounded meets a triangle, by Cramer's rule, and how wrong float32 may be about it.
struct Reference {
  bool parallel = false;
  long double s = 0, u = 0, v = 0;
  long double blur = 0;  // of u, v and 1 - u - v
  long double s_blur = 0;

  /// 1: met with certainty, -1: missed, 0: float32 may say either.
  int verdict() const {
    if (parallel) return 0;
    const long double inside = std::min({u, v, 1 - u - v});
    if (inside < -blur || s < -s_blur) return -1;
    return inside > blur && s > s_blur ? 1 : 0;
  }
};

Reference reference(const LatticeRay& ray, const TriangleVertices& t) {
  const Vec3l o = vec_cast<long double>(ray.origin), d = vec_cast<long double>(ray.direction);
  const Vec3l a = vec_cast<long double>(t.a), ab = vec_cast<long double>(t.b) - a, ac = vec_cast<long double>(t.c) - a;
  const Vec3l from_a = o - a, p = cross(d, ac), q = cross(from_a, ab);
  const long double det = dot(ab, p);
  Reference r;
  // Everything the tests compute is a sum of products of these lengths, each product off by a few units of 2^-24.
  const long double far = length(from_a) + length(ab) + length(ac), e = 0x1p-20L;
  r.parallel = std::fabs(det) < e * length(d) * length(ab) * length(ac);
  if (r.parallel) return r;
  r.s = dot(ac, q) / det;
  r.u = dot(from_a, p) / det;
  r.v = dot(d, q) / det;
  r.blur = e * length(d) * far * far / std::fabs(det);
  r.s_blur = r.blur * far;
  return r;
}

struct Tally {
  int cases = 0, met = 0, missed = 0, undecided = 0, wrong = 0;
};

template <class Method>
Tally against_reference(int bits, uint64_t seed) {
  Random random(seed);
  const double top = lattice_max(bits);
  Tally tally;
  while (tally.cases < 100000) {
    const Shape shape = soup_shape(bits, 1, random.chance(0.7) ? Soup::large : Soup::small, seed + tally.cases);
    TriangleVertices t = expanded(shape.corners(0));
    const auto corner = [&](Vec3f& p) {
      for (int axis = 0; axis < 3; ++axis) p.set(axis, std::min(static_cast<float>(top), p[axis] + 0.3f));
    };
    corner(t.a), corner(t.b), corner(t.c);
    for (int i = 0; i < 20; ++i, ++tally.cases) {
      const double v = random.real(-0.3, 1.3), w = random.real(-0.3, 1.3);
      const Vec3d a = vec_cast<double>(t.a), b = vec_cast<double>(t.b), c = vec_cast<double>(t.c);
      const Vec3d target = a * (1 - v - w) + b * v + c * w;
      const Vec3d origin =
          random.chance(0.5) ? vec_cast<double>(random.point(lattice_max(bits))) : random.vector(3 * top);
      LatticeRay ray;
      if (!render::float_ray(origin, target - origin, 0, 1e300, bits, ray)) continue;
      const Reference expected = reference(ray, t);
      FloatHit hit;
      const bool met = Method::intersect(ray, t, 1e30f, hit);
      tally.undecided += expected.verdict() == 0;
      tally.met += expected.verdict() == 1;
      tally.missed += expected.verdict() == -1;
      tally.wrong += expected.verdict() == (met ? -1 : 1);
      if (!met || expected.verdict() != 1) continue;
      tally.wrong += std::fabs(hit.s - expected.s) > expected.s_blur;
      tally.wrong += std::fabs(hit.u - expected.u) > expected.blur || std::fabs(hit.v - expected.v) > expected.blur;
      // The limit is one of s, whatever the triangle's size.
      FloatHit again;
      tally.wrong += Method::intersect(ray, t, hit.s * 0.999f, again);
      tally.wrong += !Method::intersect(ray, t, hit.s * 1.001f, again);
    }
  }
  return tally;
}

/// Rays from within a ball at its vertices and at the middles of its edges that meet none of its triangles.
template <class Method>
int leaks(const Shape& ball, int bits) {
  const std::vector<TriangleVertices> triangles = expanded(ball);
  const double top = lattice_max(bits);
  Random random(3);
  int missed = 0;
  for (int i = 0; i < 3; ++i) {
    const Vec3d origin = Vec3d{0.5, 0.5, 0.5} * top + random.vector(0.2 * top);
    for (const auto& corners : ball.triangles) {
      const Vec3d a = vec_cast<double>(ball.vertices[corners[0]]), b = vec_cast<double>(ball.vertices[corners[1]]);
      for (const Vec3d target : {a, (a + b) * 0.5}) {
        LatticeRay ray;
        REQUIRE(render::float_ray(origin, target - origin, 0, 1e300, bits, ray));
        FloatHit hit;
        missed += std::none_of(triangles.begin(), triangles.end(),
                               [&](const auto& t) { return Method::intersect(ray, t, 1e30f, hit); });
      }
    }
  }
  return missed;
}

}  // namespace

TEST_CASE("float ray: the nearest floats to the ray, from where it enters the cube") {
  for (const int bits : {10, 21, 24}) {
    Random random(static_cast<uint64_t>(bits));
    const double top = lattice_max(bits);
    int entered = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vec3d o = random.vector(3 * top);
      const Vec3d d = (vec_cast<double>(random.point(lattice_max(bits))) - o) * random.real(-0.1, 1);
      LatticeRay ray, snapped;
      const bool enters = render::float_ray(o, d, 0, 1e300, bits, ray);
      // Only a ray that passes the cube's edge by less than either moves it may be judged otherwise.
      if (snap_ray(o, d, 0, 1e300, bits, snapped) != enters) continue;
      if (!enters) continue;
      ++entered;
      REQUIRE(std::fabs(ray.direction[ray.axis]) == 1);
      for (const float s : {0.0f, 0.5f * ray.s_exit, ray.s_exit}) {
        const Vec3d expected = o + d * ray.t_at(s);
        for (int axis = 0; axis < 3; ++axis) {
          const double p = double{ray.origin[axis]} + double{s} * ray.direction[axis];
          REQUIRE(std::fabs(p - expected[axis]) <= top * 0x1p-23);
        }
      }
      const double outside = top * (0x1p-16 + 0x1p-22);
      for (int axis = 0; axis < 3; ++axis) {
        REQUIRE(ray.origin[axis] >= -outside);
        REQUIRE(ray.origin[axis] <= top + outside);
      }
    }
    CHECK(entered > 10000);
  }
  LatticeRay ray;
  const double nan = std::nan("");
  CHECK_FALSE(render::float_ray({nan, 0, 0}, {1, 0, 0}, 0, 1, 21, ray));
  CHECK_FALSE(render::float_ray({0, 0, 0}, {0, 0, 0}, 0, 1, 21, ray));
  CHECK_FALSE(render::float_ray({-1000, 5, 5}, {1, 0, 0}, 0, 900, 21, ray));
}

TEST_CASE("float tests: as in extended precision, but for what rounding may decide") {
  for (const int bits : {12, 21, 24}) {
    CAPTURE(bits);
    for (const Tally& tally : {against_reference<MollerTrumbore>(bits, 1), against_reference<Woop>(bits, 1)}) {
      CHECK(tally.wrong == 0);
      CHECK(tally.met > 15000);
      CHECK(tally.missed > 30000);
      CHECK(tally.undecided < tally.cases / 20);
    }
  }
}

TEST_CASE("float tests: Woop's leaves no hole at edges and vertices, Moller and Trumbore's does") {
  const Shape ball = sphere_shape(24, 4);
  CHECK(leaks<Woop>(ball, 24) == 0);
  CHECK(leaks<MollerTrumbore>(ball, 24) > 0);
}

TEST_CASE("trace: float tests in the kernel find what the exact one finds, nearly always, on either form of vertices") {
  const TempFolder folder;
  const Shape shape = soup_shape(24, 300, Soup::small, 1);
  Contents lattice(shape, 24, false), floats = lattice;
  floats.store_floats(5);
  const auto on_lattice = nkd::ObjectFile::open(lattice.write(folder.file("a.nkd")));
  const auto in_floats = nkd::ObjectFile::open(floats.write(folder.file("b.nkd")));
  REQUIRE(on_lattice);
  REQUIRE(in_floats);
  Random random(2);
  std::vector<render::RayRecord> rays;
  for (int i = 0; i < 20000; ++i) {
    const Vec3d o = random.vector(3.0 * lattice_max(24));
    const auto& t = shape.corners(random.integer(0, 299));
    const double v = random.unit(), w = random.unit() * (1 - v);
    const Vec3d a = vec_cast<double>(t[0]), b = vec_cast<double>(t[1]), c = vec_cast<double>(t[2]);
    const Vec3f of = vec_cast<float>(o), df = vec_cast<float>(a * (1 - v - w) + b * v + c * w - o);
    rays.push_back({of.x, of.y, of.z, 0, df.x, df.y, df.z, 1e30f});
  }
  const auto exact = render::cpu_trace(*on_lattice, {rays, RayMode::closest, 0, 1}, 0);
  REQUIRE(exact);
  for (const auto* file : {&*on_lattice, &*in_floats}) {
    for (const auto test : {render::TriangleTest::moller_trumbore, render::TriangleTest::woop}) {
      for (const auto mode : {RayMode::closest, RayMode::any}) {
        const auto traced = render::cpu_trace(*file, {rays, mode, 0, 1, true, test}, 0);
        REQUIRE(traced);
        CHECK(traced->steps.triangles > 0);
        int differ = 0, met = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
          const render::HitRecord &hit = traced->hits[i], &expected = exact->hits[i];
          if ((hit.primitive < 0) != (expected.primitive < 0) ||
              (mode == RayMode::closest && hit.primitive != expected.primitive)) {
            ++differ;
          } else if (hit.primitive >= 0 && mode == RayMode::closest) {
            ++met;
            differ += std::fabs(hit.t - expected.t) > 1e-4f * expected.t;
            differ += std::fabs(hit.u - expected.u) > 1e-2f || std::fabs(hit.v - expected.v) > 1e-2f;
          }
        }
        CHECK(differ < 20);
        if (mode == RayMode::closest) CHECK(met > 10000);
      }
    }
  }
}
