// Taking a ray onto the grid: what exactness rests on, and how far the ray may move.
#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

#include "core/lattice_ray.h"
#include "core/shapes.h"

using namespace kd;
using namespace kd::test;

namespace {

PlainRay some_ray(Random& random, int bits) {
  const double top = lattice_max(bits);
  const auto inside = [&] { return Vec3d{random.real(0, top), random.real(0, top), random.real(0, top)}; };
  const Vec3d target = random.chance(0.2) ? vec_cast<double>(random.point(lattice_max(bits))) : inside();
  Vec3d d;
  switch (random.integer(0, 3)) {
    case 0:
      d = random.vector(1);
      break;
    case 1:
      d = random.vector(1) * std::pow(10.0, random.real(-12, 12));
      break;
    case 2: {
      d = random.vector(1e-6);
      d.set(static_cast<int>(random.integer(0, 2)), random.chance(0.5) ? 1 : -1);
      break;
    }
    default: {
      d = random.vector(1);
      d.set(static_cast<int>(random.integer(0, 2)), 0);
    }
  }
  const double back = random.chance(0.3) ? 0 : random.real(0, random.chance(0.2) ? 1e6 : 4) * top / length(d);
  return {target - d * back, d};
}

bool on_grid(double value, double grid) { return value / grid == std::nearbyint(value / grid); }

}  // namespace

TEST_CASE("snap_ray: the grids, and exact differences in float32") {
  for (const int bits : {1, 10, 16, 21, 24}) {
    CAPTURE(bits);
    Random random(static_cast<uint64_t>(bits));
    const double grid = std::ldexp(1.0, bits - 24), top = lattice_max(bits);
    int off_grid = 0, inexact = 0, outside = 0, wrong_axis = 0, snapped = 0;
    for (int i = 0; i < 50000; ++i) {
      const PlainRay plain = some_ray(random, bits);
      LatticeRay ray;
      if (!snap_ray(plain.origin, plain.direction, 0, 1e300, bits, ray)) continue;
      ++snapped;
      const Vec3u v = random.point(lattice_max(bits));
      for (int axis = 0; axis < 3; ++axis) {
        const double o = ray.origin[axis], d = ray.direction[axis];
        off_grid += !on_grid(o, grid) || !on_grid(d, 0x1p-24) || std::fabs(d) > 1;
        outside += o < -1 || o > top + 1;
        const float difference = static_cast<float>(v[axis]) - ray.origin[axis];
        inexact += double{difference} != static_cast<double>(v[axis]) - o;
      }
      wrong_axis += std::fabs(ray.direction[ray.axis]) != 1;
    }
    CHECK(snapped > 40000);
    CHECK(off_grid == 0);
    CHECK(outside == 0);
    CHECK(inexact == 0);
    CHECK(wrong_axis == 0);
  }
}

TEST_CASE("snap_ray: the line stays beside the true one, from end to end, where that begins in the cube") {
  for (const int bits : {1, 10, 16, 21, 24}) {
    CAPTURE(bits);
    Random random(static_cast<uint64_t>(bits) + 100);
    const long double grid = std::ldexp(1.0L, bits - 24);
    const auto top = static_cast<long double>(lattice_max(bits));
    long double worst_near = 0, worst_far = 0, worst_t = 0;
    for (int i = 0; i < 100000; ++i) {
      const PlainRay plain = some_ray(random, bits);
      LatticeRay ray;
      if (!snap_ray(plain.origin, plain.direction, 0, 1e300, bits, ray)) continue;
      const int k = ray.axis;
      const long double ok = plain.origin[k], dk = plain.direction[k];
      const long double far = ray.direction[k] > 0 ? top - ray.origin[k] : static_cast<long double>(ray.origin[k]);
      // What double costs: the terms' size by 2^-52, more than the two roundings.
      const double size = std::max({std::fabs(plain.origin.x), std::fabs(plain.origin.y), std::fabs(plain.origin.z)});
      const long double rounding = 4 * (static_cast<long double>(size) + top) * 0x1p-52L;
      bool in_cube = true;
      for (const bool at_far_end : {false, true}) {
        const long double s = at_far_end ? far : 0;
        const long double t = (ray.origin[k] + s * ray.direction[k] - ok) / dk;
        long double off = 0;
        for (int axis = 0; axis < 3; ++axis) {
          const long double p = plain.origin[axis] + t * plain.direction[axis];
          in_cube = in_cube && (at_far_end || (p >= -grid && p <= top + grid));
          const long double q = ray.origin[axis] + s * ray.direction[axis];
          off = std::max(off, std::fabs(p - q) - rounding);
        }
        if (!in_cube) break;
        (at_far_end ? worst_far : worst_near) = std::max(at_far_end ? worst_far : worst_near, off / grid);
        const long double t_here = ray.t_at(static_cast<double>(s));
        worst_t = std::max(worst_t, std::fabs(t_here - t) * std::fabs(dk) - rounding);
      }
    }
    CHECK(worst_near <= 0.5L);
    CHECK(worst_far <= 1.0L);
    CHECK(worst_t <= 0);
  }
}

TEST_CASE("snap_ray: the same where it enters through another face than the one across its axis") {
  // Four grid steps behind the snapped origin, where the ray is in the cube.
  for (const int bits : {10, 21, 24}) {
    CAPTURE(bits);
    Random random(static_cast<uint64_t>(bits) + 200);
    const long double grid = std::ldexp(1.0L, bits - 24);
    const auto top = static_cast<long double>(lattice_max(bits));
    long double worst = 0;
    PlainRay worst_ray;
    for (int i = 0; i < 200000; ++i) {
      const int k = static_cast<int>(random.integer(0, 2)), side = (k + 1) % 3;
      PlainRay plain;
      Vec3d target{random.real(0, lattice_max(bits)), random.real(0, lattice_max(bits)),
                   random.real(0, lattice_max(bits))};
      Vec3d d = random.vector(1);
      const bool up = random.chance(0.5);
      target.set(side, up ? 0 : static_cast<double>(top));
      d.set(side, (up ? 1 : -1) * random.real(0.5, 1));
      d.set(k, random.chance(0.5) ? 1 : -1);
      plain = {target - d * (2 * static_cast<double>(top)), d};
      LatticeRay ray;
      if (!snap_ray(plain.origin, plain.direction, 0, 1e300, bits, ray)) continue;
      const long double s = 4 * grid;
      const long double t = (ray.origin[k] + s * ray.direction[k] - plain.origin[k]) / plain.direction[k];
      for (int axis = 0; axis < 3; ++axis) {
        const long double p = plain.origin[axis] + t * plain.direction[axis];
        if (p < 0 || p > top) break;
        const long double off = std::fabs(p - (ray.origin[axis] + s * ray.direction[axis])) - 8 * top * 0x1p-52L;
        if (off > worst) worst_ray = plain;
        worst = std::max(worst, off);
      }
    }
    CAPTURE(worst_ray.origin.x);
    CAPTURE(worst_ray.origin.y);
    CAPTURE(worst_ray.origin.z);
    CAPTURE(worst_ray.direction.x);
    CAPTURE(worst_ray.direction.y);
    CAPTURE(worst_ray.direction.z);
    CHECK(worst / grid <= (bits < 24 ? 0.51L : 1.01L));
  }
}

TEST_CASE("snap_ray: a ray that starts on a lattice point stays there") {
  for (const int bits : {1, 10, 21, 24}) {
    Random random(1);
    for (int i = 0; i < 5000; ++i) {
      const Vec3u v = random.point(lattice_max(bits));
      LatticeRay ray;
      REQUIRE(snap_ray(vec_cast<double>(v), random.vector(1), 0, 1e300, bits, ray));
      CHECK(ray.origin == vec_cast<float>(v));
      CHECK(ray.s_min == 0);
      CHECK(ray.t_base == 0);
    }
  }
}

TEST_CASE("snap_ray: the interval") {
  LatticeRay ray;
  REQUIRE(snap_ray({-100, 500, 500}, {2, 0, 0}, 0, 1e300, 10, ray));
  CHECK(ray.origin.x == 0);
  CHECK(ray.t_at(10) == 55);
  CHECK(ray.s_exit >= 1023);
  CHECK(ray.inverse.y == kParallel);
  REQUIRE(snap_ray({-100, 500, 500}, {2, 0, 0}, 100, 200, 10, ray));
  CHECK(ray.t_at(ray.s_min) == doctest::Approx(100));
  CHECK(ray.t_at(ray.s_max) == doctest::Approx(200));
  CHECK_FALSE(snap_ray({-100, 500, 500}, {2, 0, 0}, 0, 40, 10, ray));
  CHECK_FALSE(snap_ray({-100, 500, 500}, {2, 0, 0}, 600, 1e300, 10, ray));
  CHECK_FALSE(snap_ray({-100, 500, 500}, {-2, 0, 0}, 0, 1e300, 10, ray));
}

TEST_CASE("snap_ray: misses, and what is no ray") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  LatticeRay ray;
  CHECK_FALSE(snap_ray({-5, 5000, 5}, {1, 0, 0}, 0, 1e300, 10, ray));
  CHECK_FALSE(snap_ray({-5, -5, 5}, {1, -1, 0.1}, 0, 1e300, 10, ray));
  CHECK_FALSE(snap_ray({5, 5, 5}, {0, 0, 0}, 0, 1e300, 10, ray));
  for (int axis = 0; axis < 3; ++axis) {
    for (const double bad : {nan, inf, -inf}) {
      Vec3d o{5, 5, 5}, d{1, 2, 3};
      o.set(axis, bad);
      CHECK_FALSE(snap_ray(o, {1, 2, 3}, 0, 1e300, 10, ray));
      d.set(axis, bad);
      CHECK_FALSE(snap_ray({5, 5, 5}, d, 0, 1e300, 10, ray));
    }
  }
  CHECK_FALSE(snap_ray({5, 5, 5}, {1, 0, 0}, 2, 1, 10, ray));
}
