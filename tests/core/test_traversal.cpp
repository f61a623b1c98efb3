// Traversal against looking at every triangle.
#include <doctest/doctest.h>

#include "core/shapes.h"
#include "core/traversal.h"

using namespace kd;
using namespace kd::test;

namespace {

struct Tally {
  uint64_t rays = 0, hits = 0, closest = 0, any = 0, excluded = 0, limited = 0;
};

void compare(const Traced& traced, const LatticeRay& ray, Tally& tally) {
  const ObjectView view = traced.view();
  NoCounter counter;
  ++tally.rays;
  const uint32_t expected = brute_force(traced.triangles, ray, 1e30f, kNoTriangle);
  tally.closest += traverse<RayMode::closest>(view, ray, 1e30f, kNoTriangle, counter) != expected;
  const uint32_t some = traverse<RayMode::any>(view, ray, 1e30f, kNoTriangle, counter);
  tally.any += (some == kNoTriangle) != (expected == kNoTriangle);
  if (expected == kNoTriangle) return;
  ++tally.hits;

  TriangleHit hit{};
  tally.any += some == kNoTriangle || !intersect_triangle(ray, traced.triangles[some], hit);
  double distance = 0;
  REQUIRE(ExactTest(ray).meets<RayMode::closest>(traced.triangles[expected], 0, distance, counter));
  const float s = rounded_up(distance);
  tally.limited += traverse<RayMode::closest>(view, ray, s, kNoTriangle, counter) != expected;
  // Not by the distance of the closest hit, which may be put farther to order the faces around an edge.
  REQUIRE(intersect_triangle(ray, traced.triangles[expected], hit));
  const float before = std::nextafter(std::nextafter(rounded_up(hit.s), -1.0f), -1.0f);
  tally.limited += traverse<RayMode::any>(view, ray, before, kNoTriangle, counter) != kNoTriangle;
  const float beyond = s * 1.25f + 1;
  tally.limited += traverse<RayMode::closest>(view, ray, beyond, kNoTriangle, counter) != expected;

  const uint32_t second = brute_force(traced.triangles, ray, 1e30f, expected);
  tally.excluded += traverse<RayMode::closest>(view, ray, 1e30f, expected, counter) != second;
  const uint32_t any_second = traverse<RayMode::any>(view, ray, 1e30f, expected, counter);
  tally.excluded += any_second == expected || (any_second == kNoTriangle) != (second == kNoTriangle);
}

Tally compare_all(const Traced& traced, int rays, uint64_t seed) {
  Random random(seed);
  Tally tally;
  const int bits = traced.lattice.bits;
  for (int i = 0; i < rays; ++i) {
    const PlainRay plain = adversarial_ray(traced.shape, bits, random);
    // Some start or end on the way.
    const double reach = lattice_max(bits) / std::fmax(length(plain.direction), 1e-30);
    const double t_min = random.chance(0.2) ? random.unit() * reach : 0;
    const double t_max = random.chance(0.2) ? t_min + random.unit() * reach : 1e300;
    LatticeRay ray;
    if (snap_ray(plain.origin, plain.direction, t_min, t_max, bits, ray)) compare(traced, ray, tally);
  }
  CHECK(tally.closest == 0);
  CHECK(tally.any == 0);
  CHECK(tally.excluded == 0);
  CHECK(tally.limited == 0);
  return tally;
}

}  // namespace

TEST_CASE("traversal: triangle soups, by tree and by hand") {
  for (const int bits : {3, 10, 21, 24}) {
    for (const Soup kind : {Soup::large, Soup::small, Soup::needles, Soup::mixed}) {
      CAPTURE(bits);
      CAPTURE(static_cast<int>(kind));
      const Traced traced(soup_shape(bits, 250, kind, 7), bits);
      const Tally tally = compare_all(traced, 4000, 17);
      CHECK(tally.hits > 200);
    }
  }
}

TEST_CASE("traversal: axis-aligned architecture, whose walls lie in split planes") {
  for (const int bits : {4, 10, 21, 24}) {
    CAPTURE(bits);
    CHECK(compare_all(Traced(rooms_shape(bits, 3, 1), bits), 8000, 3).hits > 2000);
    CHECK(compare_all(Traced(stacked_boxes_shape(bits, 3), bits), 8000, 4).hits > 2000);
    // As deep as a tree can be: splits that gain nothing, empty and flat cells.
    build::BuildSettings deep{{0.01, 1.5, 0.05}, kMaxDepth};
    CHECK(compare_all(Traced(rooms_shape(bits, 3, 2), bits, deep), 8000, 5).hits > 2000);
    CHECK(compare_all(Traced(soup_shape(bits, 60, Soup::mixed, 8), bits, deep), 4000, 6).hits > 200);
  }
}

TEST_CASE("traversal: closed meshes") {
  for (const int bits : {10, 21}) {
    CAPTURE(bits);
    CHECK(compare_all(Traced(sphere_shape(bits, 2), bits), 6000, 3).hits > 2000);
    CHECK(compare_all(Traced(fan_shape(bits, 256), bits), 3000, 3).hits > 1000);
  }
}

TEST_CASE("traversal: a body is entered before it is left, however narrowly") {
  // At its edges and vertices, exactly and by less than float32 can tell: a shadow ray from the wrong face starts
  // inside.
  for (const int bits : {10, 16, 21, 24}) {
    for (const bool box : {true, false}) {
      CAPTURE(bits);
      CAPTURE(box);
      const uint32_t top = lattice_max(bits), low = top / 3, high = top - top / 5;
      const Traced traced(box ? box_shape({0, low, low}, {top, high, top}) : sphere_shape(bits, 2), bits);
      Random random(5);
      int hits = 0, left_first = 0;
      for (int i = 0; i < 20000; ++i) {
        const auto corners =
            traced.shape.corners(random.integer(0, static_cast<uint32_t>(traced.shape.triangles.size() - 1)));
        const double along = random.chance(0.3) ? 0 : random.chance(0.4) ? 0.5 : random.unit();
        const Vec3d a = vec_cast<double>(corners[0]), b = vec_cast<double>(corners[1]);
        const Vec3d target = a + (b - a) * along, d = normalised(random.vector(1));
        LatticeRay ray;
        if (!snap_ray(target - d * (4.0 * top), d, 0, 1e300, bits, ray)) continue;
        NoCounter counter;
        const uint32_t met = traverse<RayMode::closest>(traced.view(), ray, 1e30f, kNoTriangle, counter);
        if (met == kNoTriangle) continue;
        ++hits;
        const TriangleVertices& t = traced.triangles[met];
        const Vec3d p = vec_cast<double>(t.a);
        left_first += dot(cross(vec_cast<double>(t.b) - p, vec_cast<double>(t.c) - p), d) > 0;
      }
      CHECK(hits > 5000);
      CHECK(left_first == 0);
    }
  }
}

TEST_CASE("traversal: at equal distance the lower index wins, whatever the order of visits") {
  // The same wall four times over, cut by further ones so that it lies in many cells.
  constexpr int kBits = 10;
  Shape shape;
  for (int copy = 0; copy < 4; ++copy) shape.add_wall({500, 0, 0}, {500, 1000, 1000});
  for (uint32_t i = 0; i < 20; ++i) shape.add_wall({0, 50 * i, 0}, {1000, 50 * i, 1000});
  const Traced traced(shape, kBits);
  CHECK(compare_all(traced, 5000, 9).hits > 1000);
  for (const double from : {-10.0, 1100.0}) {
    LatticeRay ray;
    REQUIRE(snap_ray({from, 510, 300}, {500 - from, 0.25, 0.5}, 0, 1e300, kBits, ray));
    NoCounter counter;
    const uint32_t met = traverse<RayMode::closest>(traced.view(), ray, 1e30f, kNoTriangle, counter);
    CHECK(met < 2);
    CHECK(traverse<RayMode::closest>(traced.view(), ray, 1e30f, met, counter) == met + 2);
  }
}

namespace {

void compare_from(double distance, int bits) {
  CAPTURE(bits);
  CAPTURE(distance);
  const Traced traced(rooms_shape(bits, 3, 4), bits);
  Random random(2);
  Tally tally;
  for (int i = 0; i < 4000; ++i) {
    const Vec3d target = vec_cast<double>(random.point(lattice_max(bits)));
    const Vec3d d = random.vector(1);
    LatticeRay ray;
    if (snap_ray(target - d * (distance * lattice_max(bits)), d, 0, 1e300, bits, ray)) compare(traced, ray, tally);
  }
  CHECK(tally.closest == 0);
  CHECK(tally.any == 0);
  CHECK(tally.excluded == 0);
  if (distance < 1e10) CHECK(tally.hits > 2000);
}

}  // namespace

TEST_CASE("traversal: rays from far away, in cubes, meet what the snapped ray meets") {
  for (const int bits : {10, 21, 24}) {
    for (const double distance : {1e3, 1e6, 1e8}) compare_from(distance, bits);
  }
}

TEST_CASE("traversal: rays from so far away that double cannot place them in the cube") {
  for (const int bits : {10, 21, 24}) {
    for (const double distance : {1e10, 1e12, 1e15}) compare_from(distance, bits);
  }
}

TEST_CASE("traversal: an object of one empty leaf") {
  const std::array<Node, 2> nodes{make_leaf(0, 0), make_leaf(0, 0)};
  const ObjectView view{nodes.data(), nullptr, nullptr, 10};
  LatticeRay ray;
  REQUIRE(snap_ray({-5, 5, 5}, {1, 0, 0}, 0, 1e300, 10, ray));
  NoCounter counter;
  CHECK(traverse<RayMode::closest>(view, ray, 1e30f, kNoTriangle, counter) == kNoTriangle);
}
