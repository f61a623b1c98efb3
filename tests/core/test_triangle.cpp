// The ray and triangle test against exact integers, and what follows from it: a closed mesh has no holes.
#include <doctest/doctest.h>

#include <algorithm>

#include "core/exact.h"
#include "core/shapes.h"
#include "core/triangle.h"

using namespace kd;
using namespace kd::test;

namespace {

using Corners = std::array<Vec3u, 3>;

struct Tally {
  uint64_t cases = 0, hits = 0, ties = 0, wrong = 0, inaccurate = 0;
  double worst = 0;  // error of s, in units of 2^-53 of the farthest vertex's distance
};

/// s is good to 8 roundings of the farthest vertex's distance, u and v to 8 of 1.
constexpr double kRoundings = 8;

void compare(const LatticeRay& ray, const Corners& corners, int bits, Tally& tally) {
  const ExactHit expected = exact_hit(ray, corners, bits);
  TriangleHit hit{};
  const bool met = intersect_triangle(ray, expanded(corners), hit);
  // All that lies before the origin may be left out; what straddles it may not.
  const bool behind = expected.met && expected.s < 0;
  ++tally.cases;
  tally.hits += expected.met;
  tally.ties += expected.met && expected.touches;
  if (met != expected.met && !(behind && !met)) ++tally.wrong;
  if (!met || !expected.met) return;
  const double unit = 0x1p-53;
  const double off_s = static_cast<double>(std::fabs(hit.s - expected.s)) / unit / std::max(expected.largest, 1e-30);
  tally.worst = std::max(tally.worst, off_s);
  const auto off = [&](double a, long double b) { return static_cast<double>(std::fabs(a - b)) > kRoundings * unit; };
  if (off_s > kRoundings || off(hit.u, expected.u) || off(hit.v, expected.v)) ++tally.inaccurate;
}

Corners some_triangle(Random& random, int bits) {
  const uint32_t top = lattice_max(bits);
  const auto near = [&](Vec3u p, uint32_t size) {
    const auto one = [&](uint32_t c) {
      const uint32_t lo = c > size ? c - size : 0, hi = std::min(top, c + size);
      return random.integer(lo, hi);
    };
    return Vec3u{one(p.x), one(p.y), one(p.z)};
  };
  const Vec3u a = random.point(top);
  switch (random.integer(0, 4)) {
    case 0:
      return {a, random.point(top), random.point(top)};  // as large as the cube
    case 1:
      return {a, near(a, 2), near(a, 2)};  // a few steps
    case 2:
      return {a, random.point(top), near(a, 1)};  // a needle
    case 3:
      return {a, near(a, top / 64 + 1), near(a, top / 64 + 1)};
    default: {  // in an axis plane
      Corners t{a, random.point(top), random.point(top)};
      const int axis = static_cast<int>(random.integer(0, 2));
      t[1].set(axis, a[axis]);
      t[2].set(axis, a[axis]);
      return t;
    }
  }
}

/// Along slopes that the grid holds, so that the snapped ray passes through `target` exactly.
PlainRay exact_ray(Vec3d target, double top, Random& random) {
  const int power = static_cast<int>(random.integer(0, 4));
  const double scale = std::ldexp(1.0, power);
  const auto slope = [&] { return random.chance(0.3) ? 0.0 : std::nearbyint(random.real(-scale, scale)) / scale; };
  Vec3d d{slope(), slope(), slope()};
  d.set(static_cast<int>(random.integer(0, 2)), random.chance(0.5) ? 1 : -1);
  const double back = std::nearbyint(random.real(0, top)) * scale;
  return {target - d * back, d};
}

PlainRay some_ray(Random& random, const Corners& t, int bits) {
  const double top = lattice_max(bits);
  const Vec3d a = vec_cast<double>(t[0]), b = vec_cast<double>(t[1]), c = vec_cast<double>(t[2]);
  const double v = random.unit(), w = random.unit() * (1 - v);
  const std::array<Vec3d, 5> targets{a, b, (a + b) * 0.5, (b + c) * 0.5, a * (1 - v - w) + b * v + c * w};
  const Vec3d target = targets[random.integer(0, 4)];
  switch (random.integer(0, 4)) {
    case 0:
    case 1:
      return exact_ray(target, top, random);
    case 2: {  // along an edge, or from one of its ends
      return {a, b - a};
    }
    case 3: {
      const Vec3d o = vec_cast<double>(random.point(lattice_max(bits)));
      return {o, target - o};
    }
    default:
      return {random.vector(3 * top), random.vector(1)};
  }
}

}  // namespace

TEST_CASE("triangle: a million random and adversarial cases are decided as exact integers decide them") {
  for (const int bits : {1, 4, 10, 16, 21, 24}) {
    CAPTURE(bits);
    Random random(static_cast<uint64_t>(bits));
    Tally tally;
    while (tally.cases < 250000) {
      const Corners triangle = some_triangle(random, bits);
      for (int i = 0; i < 4; ++i) {
        const PlainRay plain = some_ray(random, triangle, bits);
        LatticeRay ray;
        if (!snap_ray(plain.origin, plain.direction, 0, 1e300, bits, ray)) {
          ++tally.cases;
          continue;
        }
        compare(ray, triangle, bits, tally);
      }
    }
    CHECK(tally.wrong == 0);
    CHECK(tally.inaccurate == 0);
    CHECK(tally.hits > 25000);  // that the cases are worth something
    CHECK(tally.ties > 2000);
    CAPTURE(tally.worst);
    CHECK(tally.worst <= kRoundings);
  }
}

TEST_CASE("triangle: every axis-parallel ray of a small cube against every kind of small triangle") {
  constexpr int kBits = 2;
  Tally tally;
  Random random(5);
  for (int i = 0; i < 400; ++i) {
    const Corners triangle{random.point(3), random.point(3), random.point(3)};
    for (int axis = 0; axis < 3; ++axis) {
      for (int j = 0; j < 7 * 7 * 2; ++j) {
        Vec3d o, d;
        d.set(axis, j % 2 ? 1 : -1);
        o.set(axis, j % 2 ? -1 : 5);
        o.set((axis + 1) % 3, j / 2 % 7 * 0.5);
        o.set((axis + 2) % 3, j / 14 * 0.5);
        LatticeRay ray;
        REQUIRE(snap_ray(o, d, 0, 1e300, kBits, ray));
        compare(ray, triangle, kBits, tally);
      }
    }
  }
  CHECK(tally.wrong == 0);
  CHECK(tally.inaccurate == 0);
  CHECK(tally.ties > 1000);
}

TEST_CASE("triangle: its corners in any order, the same answer") {
  Random random(11);
  int differing = 0;
  for (int i = 0; i < 50000; ++i) {
    const Corners t = some_triangle(random, 21);
    const PlainRay plain = some_ray(random, t, 21);
    LatticeRay ray;
    if (!snap_ray(plain.origin, plain.direction, 0, 1e300, 21, ray)) continue;
    TriangleHit hit;
    const bool met = intersect_triangle(ray, expanded(t), hit);
    for (const Corners& other : {Corners{t[1], t[2], t[0]}, Corners{t[2], t[1], t[0]}, Corners{t[0], t[2], t[1]}}) {
      differing += intersect_triangle(ray, expanded(other), hit) != met;
    }
  }
  CHECK(differing == 0);
}

namespace {

uint32_t count_hits(const std::vector<TriangleVertices>& triangles, const LatticeRay& ray) {
  uint32_t hits = 0;
  TriangleHit hit;
  for (const TriangleVertices& t : triangles) {
    hits += intersect_triangle(ray, t, hit) && hit.s >= ray.s_min;
  }
  return hits;
}

/// Rays from `origin` at vertices, edge midpoints and centroids, `step` faces apart; returns how many did not meet the
/// surface an odd number of times, or exactly once if `once`.
uint32_t leaks(const Shape& shape, Vec3u origin, int bits, size_t step, bool once) {
  const std::vector<TriangleVertices> triangles = expanded(shape);
  const Vec3d o = vec_cast<double>(origin);
  uint32_t wrong = 0;
  for (size_t i = 0; i < shape.triangles.size(); i += step) {
    const auto t = shape.corners(i);
    const Vec3d a = vec_cast<double>(t[0]), b = vec_cast<double>(t[1]), c = vec_cast<double>(t[2]);
    for (Vec3d target : {a, (a + b) * 0.5, (b + c) * 0.5, (a + b + c) * (1.0 / 3)}) {
      LatticeRay ray;
      REQUIRE(snap_ray(o, target - o, 0, 1e300, bits, ray));
      const uint32_t hits = count_hits(triangles, ray);
      wrong += once ? hits != 1 : hits % 2 != 1;
    }
  }
  return wrong;
}

/// The same from outside, past the whole mesh: the hits are even.
uint32_t outer_leaks(const Shape& shape, int bits, int rays, uint64_t seed) {
  const std::vector<TriangleVertices> triangles = expanded(shape);
  Random random(seed);
  uint32_t wrong = 0;
  for (int i = 0; i < rays; ++i) {
    PlainRay plain = adversarial_ray(shape, bits, random);
    plain.origin = plain.origin - normalised(plain.direction) * (8.0 * lattice_max(bits));
    LatticeRay ray;
    if (snap_ray(plain.origin, plain.direction, 0, 1e300, bits, ray)) wrong += count_hits(triangles, ray) % 2;
  }
  return wrong;
}

}  // namespace

TEST_CASE("triangle: no ray leaves a closed mesh, and none meets a surface twice") {
  Random random(3);
  for (const int bits : {10, 16, 21, 24}) {
    CAPTURE(bits);
    const uint32_t top = lattice_max(bits), middle = top / 2;
    const Vec3u centre{middle, middle, middle};

    const Shape sphere = sphere_shape(bits, 3);
    CHECK(leaks(sphere, centre, bits, 1, true) == 0);
    CHECK(outer_leaks(sphere, bits, 3000, 1) == 0);

    const Shape box = box_shape({top / 5, top / 7, top / 3}, {top - 3, top - top / 4, top - 1});
    for (int i = 0; i < 200; ++i) {
      const Vec3u inside{random.integer(top / 5 + 1, top - 4), random.integer(top / 7 + 1, top - top / 4 - 1),
                         random.integer(top / 3 + 1, top - 2)};
      CHECK(leaks(box, inside, bits, 1, true) == 0);
      const Vec3u off{middle + random.integer(0, top / 8), middle - random.integer(0, top / 8), middle};
      if (i < 4) CHECK(leaks(sphere, off, bits, 7, false) == 0);
    }
    CHECK(outer_leaks(box, bits, 20000, 2) == 0);
  }
}

TEST_CASE("triangle: a vertex that 4096 triangles share is met once") {
  for (const int bits : {16, 21, 24}) {
    CAPTURE(bits);
    const Shape fan = fan_shape(bits, 4096);
    const uint32_t middle = lattice_max(bits) / 2;
    CHECK(leaks(fan, {middle, middle, middle}, bits, 61, true) == 0);
    CHECK(leaks(fan, {middle + middle / 5, middle - middle / 7, middle + middle / 9}, bits, 67, false) == 0);
    CHECK(outer_leaks(fan, bits, 200, 4) == 0);
  }
}

TEST_CASE("triangle: a ray meets the front of it, or of the same wound the other way, and never both") {
  Random random(31);
  NoCounter counter;
  int met = 0, fronts = 0, wrong = 0;
  for (const int bits : {2, 10, 21, 24}) {
    for (int i = 0; i < 60000; ++i) {
      const Corners corners = some_triangle(random, bits);
      const Vec3u target = random.chance(0.6) ? corners[random.integer(0, 2)] : random.point(lattice_max(bits));
      const Vec3d origin = vec_cast<double>(random.point(lattice_max(bits)));
      LatticeRay ray;
      if (!snap_ray(origin, vec_cast<double>(target) - origin, 0, 1e300, bits, ray)) continue;
      const TriangleVertices as_is = expanded(corners), turned = expanded({corners[0], corners[2], corners[1]});
      double s = 0;
      const bool meets = ExactTest(ray).meets<RayMode::closest>(as_is, 0, s, counter);
      const bool front = FrontTest(ray).meets<RayMode::closest>(as_is, 0, s, counter);
      const bool back = FrontTest(ray).meets<RayMode::closest>(turned, 0, s, counter);
      wrong += (front || back) != meets || (front && back);
      met += meets;
      if (!front) continue;
      ++fronts;
      const Vec3d a = vec_cast<double>(corners[0]);
      const Vec3d normal = cross(vec_cast<double>(corners[1]) - a, vec_cast<double>(corners[2]) - a);
      const Vec3d direction = vec_cast<double>(ray.direction);
      wrong += dot(normal, direction) > 1e-9 * length(normal) * length(direction);
    }
  }
  CHECK(wrong == 0);
  CHECK(met > 1000);
  CHECK(fronts > met / 3);
  CHECK(fronts < 2 * met / 3);
}
