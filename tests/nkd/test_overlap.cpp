// Triangle and box against clipping, in long double with a band in which it is not asked, and against boxes that a
// small lattice lets us count.
#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "../core/shapes.h"
#include "nkd/overlap.h"

using namespace kd;
using namespace kd::test;
using nkd::triangle_meets_box;

namespace {

using Point = std::array<long double, 3>;

/// Whether what is left of the triangle, clipped to the box grown by `margin` on each side, has a point.
bool meets_by_clipping(const std::array<Vec3u, 3>& t, const Box3u& box, long double margin) {
  std::vector<Point> polygon;
  for (Vec3u v : t) polygon.push_back({(long double)v.x, (long double)v.y, (long double)v.z});
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<size_t>(axis);
    for (const long double sign : {-1.0L, 1.0L}) {
      const long double plane = sign < 0 ? box.lo[axis] - margin : box.hi[axis] + margin;
      std::vector<Point> kept;
      for (size_t i = 0; i < polygon.size(); ++i) {
        const Point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const long double dp = sign * (p[k] - plane), dq = sign * (q[k] - plane);
        if (dp <= 0) kept.push_back(p);
        if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) {
          Point cut;
          for (size_t a = 0; a < 3; ++a) cut[a] = p[a] + dp / (dp - dq) * (q[a] - p[a]);
          kept.push_back(cut);
        }
      }
      polygon = std::move(kept);
    }
  }
  return !polygon.empty();
}

Box3u some_box(Random& random, uint32_t top, uint32_t size) {
  Box3u box;
  const Vec3u a = random.point(top);
  box.extend(a);
  box.extend(Vec3u{std::min(top, a.x + random.integer(0, size)), std::min(top, a.y + random.integer(0, size)),
                   std::min(top, a.z + random.integer(0, size))});
  return box;
}

}  // namespace

TEST_CASE("overlap: as clipping says, where clipping is sure") {
  for (const int bits : {3, 6, 10, 21, 24}) {
    CAPTURE(bits);
    const uint32_t top = lattice_max(bits);
    Random random(static_cast<uint64_t>(bits));
    const long double sure = 1e-6L;
    int wrong_closed = 0, wrong_open = 0, met = 0, touching = 0;
    for (const Soup kind : {Soup::large, Soup::small, Soup::needles}) {
      const Shape shape = soup_shape(bits, 4000, kind, 3);
      for (size_t i = 0; i < shape.triangles.size(); ++i) {
        const auto t = shape.corners(i);
        Box3u box = some_box(random, top, random.chance(0.5) ? top / 4 + 2 : 3);
        if (random.chance(0.4)) {  // around one of its points, so that near misses are common
          const Vec3u v = t[random.integer(0, 2)];
          box = {};
          box.extend(v);
          box.extend(Vec3u{std::min(top, v.x + 2), v.y - std::min(v.y, 1u), std::min(top, v.z + 1)});
        }
        const bool closed = triangle_meets_box(t, box, false), open = triangle_meets_box(t, box, true);
        const bool outside = !meets_by_clipping(t, box, sure);
        wrong_closed += (closed && outside) || (!closed && meets_by_clipping(t, box, 0));
        met += closed;
        touching += closed != open;
        const bool solid = box.lo.x < box.hi.x && box.lo.y < box.hi.y && box.lo.z < box.hi.z;
        if (!solid) continue;
        wrong_open += (!open && meets_by_clipping(t, box, -sure)) || (open && !closed);
      }
    }
    CHECK(wrong_closed == 0);
    CHECK(wrong_open == 0);
    CHECK(met > 1000);
    CHECK(touching > 20);
  }
}

TEST_CASE("overlap: touching is meeting only if the box is closed") {
  const Box3u box{{2, 2, 2}, {4, 4, 4}};
  const std::array<Vec3u, 3> face{Vec3u{4, 0, 0}, Vec3u{4, 9, 0}, Vec3u{4, 0, 9}};
  const std::array<Vec3u, 3> corner{Vec3u{4, 4, 4}, Vec3u{9, 4, 4}, Vec3u{4, 9, 9}};
  const std::array<Vec3u, 3> through{Vec3u{3, 0, 0}, Vec3u{3, 9, 0}, Vec3u{3, 0, 9}};
  const std::array<Vec3u, 3> apart{Vec3u{5, 0, 0}, Vec3u{5, 9, 0}, Vec3u{5, 0, 9}};
  for (const auto& t : {face, corner}) {
    CHECK(triangle_meets_box(t, box, false));
    CHECK_FALSE(triangle_meets_box(t, box, true));
  }
  CHECK(triangle_meets_box(through, box, true));
  CHECK_FALSE(triangle_meets_box(apart, box, false));
}

TEST_CASE("overlap: a flat box's plane counts as its interior") {
  const Box3u flat{{2, 3, 2}, {4, 3, 4}};
  const std::array<Vec3u, 3> in_plane{Vec3u{0, 3, 0}, Vec3u{9, 3, 0}, Vec3u{0, 3, 9}};
  const std::array<Vec3u, 3> above{Vec3u{0, 4, 0}, Vec3u{9, 4, 0}, Vec3u{0, 4, 9}};
  const std::array<Vec3u, 3> beside{Vec3u{4, 3, 0}, Vec3u{9, 3, 0}, Vec3u{4, 3, 9}};
  CHECK(triangle_meets_box(in_plane, flat, true));
  CHECK_FALSE(triangle_meets_box(above, flat, false));
  CHECK(triangle_meets_box(beside, flat, false));
  CHECK_FALSE(triangle_meets_box(beside, flat, true));
}

TEST_CASE("overlap: the largest coordinates there are") {
  const uint32_t top = lattice_max(24);
  const std::array<Vec3u, 3> across{Vec3u{0, 0, top}, Vec3u{top, 0, 0}, Vec3u{0, top, 0}};  // x + y + z = top
  const uint32_t third = top / 3;                                                           // top is 3 x 5592405
  CHECK(triangle_meets_box(across, {{third, third, third}, {third, third, third}}, false));
  CHECK_FALSE(triangle_meets_box(across, {{third + 1, third, third}, {third + 1, third, third}}, false));
  CHECK_FALSE(triangle_meets_box(across, {{third, third, third}, {third + 1, third + 1, third + 1}}, true));
  CHECK(triangle_meets_box(across, {{third - 1, third, third}, {third + 1, third + 1, third + 1}}, true));
}
