// Frames and their inverses: round trips within a bound that follows from how nearly the axes lie in a plane.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/frame.h"
#include "core/shapes.h"

using namespace kd;
using namespace kd::test;

namespace {

/// Largest error of p -> scene -> p over points of the unit cube, in units of 2^-52.
double round_trip(const Frame& f, Random& random) {
  const InverseFrame back = invert(f);
  double worst = 0;
  for (int i = 0; i < 20; ++i) {
    const Vec3d p{random.unit(), random.unit(), random.unit()};
    const Vec3d q = back.apply_point(f.apply_point(p));
    for (int axis = 0; axis < 3; ++axis) worst = std::max(worst, std::fabs(q[axis] - p[axis]));
  }
  return worst / 0x1p-52;
}

double size(const Frame& f) { return std::max({length(f.x_axis), length(f.y_axis), length(f.z_axis)}); }
double smallest(const Frame& f) { return std::min({length(f.x_axis), length(f.y_axis), length(f.z_axis)}); }

/// What a round trip may cost: a few roundings of the outer coordinates, seen from the shortest axis, over the volume.
double allowed(const Frame& f) {
  return 32 * (1 + (size(f) + length(f.point)) / smallest(f)) / std::fabs(relative_volume(f));
}

Frame rotated(Random& random, Vec3d lengths) {
  const Vec3d x = normalised(random.vector(1)), z = normalised(cross(x, normalised(random.vector(1))));
  const Vec3d y = cross(z, x);
  return {{0, 0, 0}, x * lengths.x, y * lengths.y, z * lengths.z};
}

}  // namespace

TEST_CASE("frame: inverses of rotated, scaled and mirrored frames") {
  Random random(1);
  for (const double scale : {1.0, 1e-12, 1e12}) {
    for (const Vec3d ratio :
         {Vec3d{1, 1, 1}, Vec3d{1, 1e3, 1e6}, Vec3d{1e-6, 1, 1}, Vec3d{-1, 1, 1}, Vec3d{-2, -3, -1}}) {
      CAPTURE(scale);
      CAPTURE(ratio.y);
      double worst = 0;
      for (int i = 0; i < 500; ++i) {
        const Frame f = rotated(random, ratio * scale);
        REQUIRE_FALSE(is_singular(f));
        REQUIRE(std::fabs(std::fabs(relative_volume(f)) - 1) < 1e-12);
        REQUIRE((relative_volume(f) < 0) == (ratio.x * ratio.y * ratio.z < 0));
        worst = std::max(worst, round_trip(f, random) / allowed(f));
      }
      CHECK(worst <= 1);
    }
  }
}

TEST_CASE("frame: axis-aligned boxes of any ratio lose nothing to it") {
  Random random(2);
  for (const double scale : {1.0, 1e-12, 1e12}) {
    const Frame f{{0, 0, 0}, {scale, 0, 0}, {0, 1e6 * scale, 0}, {0, 0, -1e-6 * scale}};
    CHECK(round_trip(f, random) <= 4);
  }
}

TEST_CASE("frame: inverses of sheared frames") {
  Random random(3);
  double worst = 0;
  for (int i = 0; i < 5000; ++i) {
    const Frame f{random.vector(1), random.vector(1), random.vector(1), random.vector(1)};
    if (std::fabs(relative_volume(f)) < 1e-6) continue;
    worst = std::max(worst, round_trip(f, random) / allowed(f));
  }
  CHECK(worst <= 1);
}

TEST_CASE("frame: a million sizes away, only the point's own digits are lost") {
  Random random(4);
  for (const double scale : {1e-12, 1.0, 1e12}) {
    for (int i = 0; i < 500; ++i) {
      Frame f = rotated(random, Vec3d{1, 2, 0.5} * scale);
      f.point = normalised(random.vector(1)) * (1e6 * scale);
      REQUIRE(round_trip(f, random) <= allowed(f));
      REQUIRE(round_trip(f, random) * 0x1p-52 < 1e-8);
    }
  }
}

TEST_CASE("frame: directions, normals and composition") {
  Random random(5);
  for (int i = 0; i < 500; ++i) {
    const Frame f{random.vector(5), random.vector(1), random.vector(1), random.vector(1)};
    const Frame g{random.vector(5), random.vector(1), random.vector(1), random.vector(1)};
    if (std::fabs(relative_volume(f)) < 1e-3 || std::fabs(relative_volume(g)) < 1e-3) continue;
    const InverseFrame back = invert(f);
    const Vec3d a = random.vector(1), b = random.vector(1);
    const Vec3d n_outer = back.normal_to_outer(cross(a, b));
    REQUIRE(std::fabs(dot(normalised(n_outer), normalised(f.apply_vector(a)))) < 1e-11);
    REQUIRE(std::fabs(dot(normalised(n_outer), normalised(f.apply_vector(b)))) < 1e-11);
    REQUIRE(length(compose(f, g).apply_point(a) - f.apply_point(g.apply_point(a))) < 1e-13);
    REQUIRE(length(back.apply_vector(f.apply_vector(a)) - a) < 1e-9);
  }
}

TEST_CASE("frame: singular ones are told") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double scale : {1e-12, 1.0, 1e12}) {
    CAPTURE(scale);
    const auto frame = [&](Vec3d x, Vec3d y, Vec3d z) { return Frame{{0, 0, 0}, x * scale, y * scale, z * scale}; };
    CHECK_FALSE(is_singular(frame({1, 0, 0}, {0, 1, 0}, {0, 0, 1})));
    CHECK_FALSE(is_singular(frame({1, 0, 0}, {0, 1e-6, 0}, {0, 0, 1e6})));
    CHECK_FALSE(is_singular(frame({1, 0, 0}, {1, 1e-6, 0}, {0, 0, 1})));
    CHECK(is_singular(frame({1, 0, 0}, {1, 1e-10, 0}, {0, 0, 1})));
    CHECK(is_singular(frame({1, 0, 0}, {0, 1, 0}, {1, 1, 0})));
    CHECK(is_singular(frame({1, 0, 0}, {2, 0, 0}, {0, 0, 1})));
    CHECK(is_singular(frame({0, 0, 0}, {0, 1, 0}, {0, 0, 1})));
    CHECK(is_singular(frame({1, 0, nan}, {0, 1, 0}, {0, 0, 1})));
    CHECK(is_singular(frame({1, 0, 0}, {0, HUGE_VAL, 0}, {0, 0, 1})));
  }
  CHECK(is_singular(Frame{{nan, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
}
