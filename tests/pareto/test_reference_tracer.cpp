// The tracer that errors are measured against, against exact integers, brute force and plain geometry.
#include <random>

#include <doctest/doctest.h>

#include "pareto/meshes.h"
#include "pareto/reference_tracer.h"

using namespace kd;
using namespace kd::bench;

namespace {

using Vec3i = Vec3<int64_t>;

Vec3d random_point(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> c(-size, size);
  const double x = c(random), y = c(random);
  return {x, y, c(random)};
}

}  // namespace

TEST_SUITE("the reference tracer") {
  // With integers up to 16 and a direction whose largest component is 8, all the arithmetic of `meets` is exact, and so
  // is the test by volumes: many of these rays pass through edges and vertices, or lie in the triangle's plane.
  TEST_CASE("a ray and a triangle in exact integers") {
    std::mt19937 random(7);
    std::uniform_int_distribution<int64_t> coordinate(-16, 16), slope(-8, 8);
    int met = 0, border = 0, flat = 0;
    for (int i = 0; i < 400000; ++i) {
      const auto point = [&] {
        const int64_t x = coordinate(random), y = coordinate(random);
        return Vec3i{x, y, coordinate(random)};
      };
      const Vec3i o = point(), a = point(), b = point(), c = point();
      Vec3i d{slope(random), slope(random), slope(random)};
      d.set(i % 3, i % 2 ? 8 : -8);
      const auto volume = [&](Vec3i p, Vec3i q) { return dot(d, cross(p - o, q - o)); };
      const int64_t u = volume(b, c), v = volume(c, a), w = volume(a, b), sum = u + v + w;
      const bool inside = sum != 0 && ((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0));
      met += inside;
      border += inside && (u == 0 || v == 0 || w == 0);
      flat += sum == 0;

      ReferenceHit hit;
      const Corners corners{vec_cast<double>(a), vec_cast<double>(b), vec_cast<double>(c)};
      REQUIRE(meets({vec_cast<double>(o), vec_cast<double>(d)}, corners, hit) == inside);
      if (!inside) continue;
      const Vec3i n = cross(b - a, c - a);
      const double t = static_cast<double>(dot(a - o, n)) / static_cast<double>(dot(d, n));
      CHECK(hit.t == doctest::Approx(t).epsilon(1e-13));
      CHECK(hit.u == doctest::Approx(static_cast<double>(v) / static_cast<double>(sum)).epsilon(1e-13));
      CHECK(hit.v == doctest::Approx(static_cast<double>(w) / static_cast<double>(sum)).epsilon(1e-13));
    }
    CHECK(met > 10000);
    CHECK(border > 300);
    CHECK(flat > 500);
  }

  TEST_CASE("the hierarchy finds what brute force finds") {
    std::mt19937 random(11);
    std::vector<Corners> triangles;
    for (int i = 0; i < 700; ++i) {
      const Vec3d p = random_point(random, 1);
      triangles.push_back({p, p + random_point(random, 0.3), p + random_point(random, 0.3)});
      if (i % 7 == 0) triangles.push_back(triangles[static_cast<size_t>(i / 2)]);  // coincident ones
    }
    const ReferenceTracer tracer(triangles);
    for (int i = 0; i < 4000; ++i) {
      Ray ray{random_point(random, i % 2 ? 1 : 5), random_point(random, 1), 0, i % 3 ? 1e30 : 1.5};
      if (i % 5 == 0) ray.direction.set(i % 3, 0);
      ReferenceHit best;
      double nearest = ray.t_max, distance = 1e30;
      for (size_t t = 0; t < triangles.size(); ++t) {
        const Vec3d away = nearest_point(triangles[t], ray.origin) - ray.origin;
        distance = std::min(distance, length(away));
        ReferenceHit hit;
        if (!meets(ray, triangles[t], hit) || hit.t < 0 || hit.t > nearest || (hit.t == nearest && best.triangle >= 0))
          continue;
        nearest = hit.t;
        best = hit;
        best.triangle = static_cast<int64_t>(t);
      }
      const ReferenceHit found = tracer.closest_hit(ray);
      REQUIRE(found.triangle == best.triangle);
      CHECK(found.t == best.t);
      CHECK(tracer.any_hit(ray) == (best.triangle >= 0));
      CHECK(tracer.distance(ray.origin) == doctest::Approx(distance));
      CHECK(tracer.distance(ray.origin, 0.5 * distance) == doctest::Approx(0.5 * distance));
    }
  }

  // Every ray from inside a closed mesh meets it: at vertices and edges most of all.
  TEST_CASE("no ray leaves a closed mesh") {
    for (const char* name : {"icosphere.ply", "cube.obj"}) {
      const mesh::Mesh mesh = test::data_mesh(name);
      const ReferenceTracer tracer(test::corners_of(mesh));
      const Vec3d centre = (tracer.box().lo + tracer.box().hi) * 0.5;
      std::mt19937 random(3);
      for (int round = 0; round < 10; ++round) {
        const Vec3d o = centre + random_point(random, 0.2) * tracer.box().extent();
        for (const auto& t : mesh.triangles) {
          const Vec3d a = mesh.positions[t[0]], b = mesh.positions[t[1]];
          for (Vec3d target : {a, (a + b) * 0.5}) REQUIRE(tracer.closest_hit({o, target - o}).triangle >= 0);
        }
      }
    }
  }

  TEST_CASE("depths on a cube") {
    const mesh::Mesh mesh = test::data_mesh("cube.obj");
    const ReferenceTracer tracer(test::corners_of(mesh));
    const Vec3d lo = tracer.box().lo, hi = tracer.box().hi;
    std::mt19937 random(5);
    for (int i = 0; i < 1000; ++i) {
      const Vec3d o = (lo + hi) * 0.5 + random_point(random, 0.4) * (hi - lo), d = random_point(random, 1);
      double expected = 1e30;
      for (int axis = 0; axis < 3; ++axis)
        expected = std::min(expected, ((d[axis] > 0 ? hi : lo)[axis] - o[axis]) / d[axis]);
      CHECK(tracer.closest_hit({o, d}).t == doctest::Approx(expected).epsilon(1e-9));
    }
  }

  // q is the point of a convex set nearest to p if and only if it lies in the set and no corner lies on p's side of it.
  TEST_CASE("the nearest point of a triangle") {
    std::mt19937 random(13);
    int at_corner = 0, at_edge = 0, within = 0;
    for (int i = 0; i < 20000; ++i) {
      const Corners c{random_point(random, 1), random_point(random, 1), random_point(random, 1)};
      const Vec3d p = random_point(random, 2), q = nearest_point(c, p);
      for (Vec3d corner : c) CHECK(dot(p - q, corner - q) <= 1e-12);
      // q's weights, by areas: they sum to 1 only inside.
      const double whole = length(cross(c[1] - c[0], c[2] - c[0]));
      const double parts[3] = {length(cross(c[1] - q, c[2] - q)), length(cross(c[2] - q, c[0] - q)),
                               length(cross(c[0] - q, c[1] - q))};
      CHECK(parts[0] + parts[1] + parts[2] == doctest::Approx(whole).epsilon(1e-9));
      const auto zeros = std::count_if(parts, parts + 3, [](double part) { return part < 1e-12; });
      at_corner += zeros == 2;
      at_edge += zeros == 1;
      within += zeros == 0;
    }
    CHECK(at_corner > 1000);
    CHECK(at_edge > 1000);
    CHECK(within > 500);
  }
}
