// A hit counts wherever on the ray it lies. Traversal that takes only hits within a leaf's own interval loses
// triangles that lie in split planes, or that a leaf knows of but the ray meets in the next one. The variant below does
// that, to show that these tests would notice.
#include <doctest/doctest.h>

#include "core/shapes.h"
#include "core/traversal.h"

using namespace kd;
using namespace kd::test;

namespace {

struct IntervalTraversal {
  const ObjectView& object;
  const LatticeRay& ray;

  uint32_t visit(uint32_t index, float entry, float exit) const {
    const Node node = object.nodes[index];
    if (is_leaf(node)) {
      uint32_t best = kNoTriangle;
      float s_best = exit;
      for (uint32_t r = first_reference(node); r < first_reference(node) + reference_count(node); ++r) {
        TriangleHit hit;
        if (!intersect_triangle(ray, object.triangles[object.references[r]], hit)) continue;
        const float s = rounded_up(hit.s);
        if (s < entry || s > s_best || (s == s_best && best != kNoTriangle)) continue;
        best = object.references[r];
        s_best = s;
      }
      return best;
    }
    const int axis = split_axis(node);
    const float s = (split_plane(node) - ray.origin[axis]) * ray.inverse[axis];
    const uint32_t near = child_of(node, ray.inverse[axis] < 0 ? 1 : 0);
    const uint32_t far = child_of(node, ray.inverse[axis] < 0 ? 0 : 1);
    if (s > exit) return visit(near, entry, exit);
    if (s < entry) return visit(far, entry, exit);
    const uint32_t met = visit(near, entry, s);
    return met != kNoTriangle ? met : visit(far, s, exit);
  }
};

struct Losses {
  int rays = 0, ours = 0, variant = 0;
};

/// How often each finds another triangle than looking at all of them does.
Losses losses(const ObjectView& view, std::span<const TriangleVertices> triangles, std::span<const PlainRay> rays) {
  Losses l;
  for (const PlainRay& plain : rays) {
    LatticeRay ray;
    if (!snap_ray(plain.origin, plain.direction, 0, 1e300, view.bits, ray)) continue;
    NoCounter counter;
    const uint32_t expected = brute_force(triangles, ray, 1e30f, kNoTriangle);
    ++l.rays;
    l.ours += traverse<RayMode::closest>(view, ray, 1e30f, kNoTriangle, counter) != expected;
    l.variant += IntervalTraversal{view, ray}.visit(0, ray.s_min, std::fmin(ray.s_exit, ray.s_max)) != expected;
  }
  return l;
}

/// From the upper side of a plane across `axis` to points of the plane, at any slope.
std::vector<PlainRay> rays_at_plane(int axis, double plane, double top, int count) {
  Random random(static_cast<uint64_t>(axis) + 1);
  std::vector<PlainRay> rays;
  for (int i = 0; i < count; ++i) {
    Vec3d target{random.real(1, top - 1), random.real(1, top - 1), random.real(1, top - 1)};
    Vec3d origin{random.real(0, top), random.real(0, top), random.real(0, top)};
    target.set(axis, plane);
    origin.set(axis, random.real(plane + 1, 2 * top));
    rays.push_back({origin, target - origin});
  }
  return rays;
}

}  // namespace

TEST_CASE("interval: a wall in a split plane, referenced from one side only") {
  // A house of two rooms: its floor, its ceiling and a wall between the rooms, stored with the lower room.
  constexpr int kBits = 10;
  constexpr uint32_t kTop = 1023, kWall = 331;
  for (int axis = 0; axis < 3; ++axis) {
    CAPTURE(axis);
    const int up = (axis + 1) % 3;
    Shape house;
    const auto wall = [&](int across, uint32_t at) {
      Vec3u lo{0, 0, 0}, hi{kTop, kTop, kTop};
      lo.set(across, at);
      hi.set(across, at);
      house.add_wall(lo, hi);
    };
    wall(axis, kWall);
    wall(up, 0);
    wall(up, kTop);
    const std::vector<TriangleVertices> triangles = expanded(house);
    const std::array<Node, 4> nodes{make_inner(axis, kWall, 2), Node{}, make_leaf(0, 6), make_leaf(2, 4)};
    const std::array<uint32_t, 6> references{0, 1, 2, 3, 4, 5};
    const ObjectView view{nodes.data(), references.data(), triangles.data(), kBits};
    const Losses l = losses(view, triangles, rays_at_plane(axis, kWall, kTop, 5000));
    CHECK(l.rays == 5000);
    CHECK(l.ours == 0);
    CHECK(l.variant > 0);
  }
}

TEST_CASE("interval: a wall across two cells that the leaf before the hit refers to") {
  // The wall y = 500 reaches through both cells; only the right one, which the rays come through, refers to it.
  constexpr int kBits = 10;
  Shape shape;
  shape.add_wall({0, 500, 0}, {1023, 500, 1023});
  shape.add_wall({0, 800, 0}, {300, 800, 1023});   // in the left cell, behind it on the way
  shape.add_wall({400, 0, 0}, {400, 1023, 1023});  // in the left cell, before it for steep rays only
  const std::vector<TriangleVertices> triangles = expanded(shape);
  const std::array<Node, 4> nodes{make_inner(0, 512, 2), Node{}, make_leaf(2, 4), make_leaf(0, 2)};
  const std::array<uint32_t, 6> references{0, 1, 2, 3, 4, 5};
  const ObjectView view{nodes.data(), references.data(), triangles.data(), kBits};
  Random random(1);
  std::vector<PlainRay> rays;
  for (int i = 0; i < 2000; ++i) {
    const Vec3d origin{random.real(520, 1000), random.real(0, 490), random.real(0, 1000)};
    rays.push_back({origin, Vec3d{random.real(405, 510), 500, random.real(0, 1000)} - origin});
  }
  const Losses l = losses(view, triangles, rays);
  CHECK(l.ours == 0);
  CHECK(l.variant > 1900);
}

TEST_CASE("interval: rooms under the tree that the builder makes") {
  for (const int bits : {10, 21, 24}) {
    CAPTURE(bits);
    const Traced traced(rooms_shape(bits, 4, 5), bits);
    Random random(9);
    std::vector<PlainRay> rays;
    for (int i = 0; i < 20000; ++i) rays.push_back(adversarial_ray(traced.shape, bits, random));
    const Losses l = losses(traced.view(), traced.triangles, rays);
    CHECK(l.rays > 15000);
    CHECK(l.ours == 0);
    CHECK(l.variant > 0);
  }
}
