// Clipped bounds contain what of a triangle lies in a cell, and are at most a step larger.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "../core/shapes.h"
#include "build/clip.h"
#include "nkd/overlap.h"

using namespace kd;
using namespace kd::test;

namespace {

/// The box of the triangle's part in the closed cell, found as one side of a cell that is split in two.
std::optional<Box3u> clipped_bounds(const build::LatticeTriangle& t, const Box3u& cell, int axis, bool lower) {
  Box3u parent = cell;
  if (lower) {
    parent.hi.set(axis, parent.hi[axis] + parent.hi[axis] / 7);
  } else {
    parent.lo.set(axis, parent.lo[axis] - parent.lo[axis] / 7);
  }
  const build::SplitBounds parts = build::split_bounds(t, parent, axis, lower ? cell.hi[axis] : cell.lo[axis]);
  const Box3u& part = lower ? parts.below : parts.above;
  if (part.empty()) return std::nullopt;
  return part;
}

using Point = std::array<long double, 3>;

/// The triangle's part in the closed cell; 64 bits of mantissa are exact enough for boxes of whole numbers.
std::vector<Point> clipped(const build::LatticeTriangle& t, const Box3u& cell) {
  std::vector<Point> polygon;
  for (Vec3u v : t) {
    polygon.push_back({static_cast<long double>(v.x), static_cast<long double>(v.y), static_cast<long double>(v.z)});
  }
  for (size_t k = 0; k < 3; ++k) {
    for (const long double sign : {-1.0L, 1.0L}) {
      const long double plane = sign < 0 ? cell.lo[static_cast<int>(k)] : cell.hi[static_cast<int>(k)];
      std::vector<Point> kept;
      for (size_t i = 0; i < polygon.size(); ++i) {
        const Point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const long double dp = sign * (p[k] - plane), dq = sign * (q[k] - plane);
        if (dp <= 0) kept.push_back(p);
        if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) {
          Point cut;
          for (size_t a = 0; a < 3; ++a) cut[a] = p[a] + dp / (dp - dq) * (q[a] - p[a]);
          cut[k] = plane;
          kept.push_back(cut);
        }
      }
      polygon = std::move(kept);
    }
  }
  return polygon;
}

}  // namespace

TEST_CASE("clip: never smaller than the triangle's part of the cell, never two steps larger") {
  for (const int bits : {4, 10, 21, 24}) {
    CAPTURE(bits);
    const uint32_t top = lattice_max(bits);
    Random random(static_cast<uint64_t>(bits));
    int small = 0, loose = 0, lost = 0, phantom = 0, parts = 0, outside = 0;
    for (const Soup kind : {Soup::large, Soup::small, Soup::needles}) {
      const Shape shape = soup_shape(bits, 6000, kind, 9);
      for (size_t i = 0; i < shape.triangles.size(); ++i) {
        const auto t = shape.corners(i);
        const Vec3u near = t[random.integer(0, 2)];
        Box3u cell;
        cell.extend(random.chance(0.6) ? near : random.point(top));
        const uint32_t size = random.chance(0.3) ? 2 : top / 3 + 1;
        cell.extend(Vec3u{std::min(top, cell.lo.x + random.integer(0, size)),
                          std::min(top, cell.lo.y + random.integer(0, size)),
                          std::min(top, cell.lo.z + random.integer(0, size))});
        const auto box = clipped_bounds(t, cell, static_cast<int>(random.integer(0, 2)), random.chance(0.5));
        const bool meets = nkd::triangle_meets_box(t, cell, false);
        lost += meets && !box;
        if (!box) continue;
        Box3u wide = cell;
        for (int axis = 0; axis < 3; ++axis) {
          wide.lo.set(axis, std::max(wide.lo[axis], 1u) - 1);
          wide.hi.set(axis, wide.hi[axis] + 1);
          outside += box->lo[axis] < cell.lo[axis] || box->hi[axis] > cell.hi[axis] || box->lo[axis] > box->hi[axis];
        }
        phantom += !nkd::triangle_meets_box(t, wide, false);
        const std::vector<Point> part = clipped(t, cell);
        if (part.empty()) continue;
        ++parts;
        for (size_t k = 0; k < 3; ++k) {
          const auto [lo, hi] = std::minmax_element(part.begin(), part.end(),
                                                    [&](const Point& a, const Point& b) { return a[k] < b[k]; });
          const int axis = static_cast<int>(k);
          const long double sure = 1e-9L;
          small += box->lo[axis] > (*lo)[k] + sure || box->hi[axis] < (*hi)[k] - sure;
          // At a shallow angle to a face, widening the cell by 2^-20 lengthens the part by more than that.
          loose += kind == Soup::small && ((*lo)[k] - box->lo[axis] > 2 || box->hi[axis] - (*hi)[k] > 2);
        }
      }
    }
    CHECK(parts > 5000);
    CHECK(lost == 0);
    CHECK(small == 0);
    CHECK(outside == 0);
    CHECK(phantom == 0);
    CHECK(loose == 0);
  }
}

TEST_CASE("clip: known parts") {
  const build::LatticeTriangle t{Vec3u{0, 0, 0}, Vec3u{8, 0, 0}, Vec3u{0, 8, 0}};
  CHECK(build::bounds(t) == Box3u{{0, 0, 0}, {8, 8, 0}});
  const build::SplitBounds halves = build::split_bounds(t, {{0, 0, 0}, {8, 8, 8}}, 0, 4);
  CHECK(halves.below == Box3u{{0, 0, 0}, {4, 8, 0}});
  CHECK(halves.above.lo == Vec3u{4, 0, 0});
  CHECK(halves.above.hi.x == 8);
  CHECK(halves.above.hi.y <= 5);
  CHECK(halves.above.hi.z == 0);
  CHECK_FALSE(clipped_bounds(t, {{5, 5, 0}, {8, 8, 8}}, 0, true));
  CHECK_FALSE(clipped_bounds(t, {{0, 0, 1}, {8, 8, 8}}, 1, false));
  const auto corner = clipped_bounds(t, {{4, 4, 0}, {8, 8, 8}}, 0, false);
  REQUIRE(corner);
  CHECK(corner->lo == Vec3u{4, 4, 0});
  CHECK(corner->hi.x <= 5);
  CHECK(corner->hi.y <= 5);
  const auto band = clipped_bounds(t, {{2, 0, 0}, {3, 8, 8}}, 1, true);
  REQUIRE(band);
  CHECK(band->lo == Vec3u{2, 0, 0});
  CHECK(band->hi.y <= 7);
  CHECK(band->hi.y >= 6);
}

TEST_CASE("clip: a sliver thinner than double can tell") {
  // Of this needle, 2e-11 steps of x lie in the cell's interior, and double has 5e-10 there.
  const build::LatticeTriangle needle{Vec3u{2094740, 54102, 2059874}, Vec3u{2094740, 2095866, 2059875},
                                      Vec3u{2094741, 2095866, 5302}};
  const auto box = clipped_bounds(needle, {{2094740, 54202, 2059874}, {2094753, 54203, 2059883}}, 1, true);
  REQUIRE(box);
  CHECK(box->lo.x == 2094740);
  CHECK(box->hi.x == 2094741);
}
