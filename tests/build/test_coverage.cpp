// No leaf lacks a triangle that passes through its cell: every leaf against every triangle, in exact integers.
#include <doctest/doctest.h>

#include <algorithm>

#include "builds.h"
#include "core/tree_statistics.h"
#include "nkd/overlap.h"

using namespace kd;
using namespace kd::test;

namespace {

struct Leaf {
  Box3u cell;
  std::span<const uint32_t> references;
  bool refers_to(uint32_t triangle) const { return std::binary_search(references.begin(), references.end(), triangle); }
};

std::vector<Leaf> leaves_of(const build::Tree& tree, const Lattice& lattice) {
  std::vector<Leaf> leaves;
  for_each_node(tree.nodes, lattice, [&](uint32_t, Node node, const Box3u& cell, uint32_t) {
    if (!is_leaf(node)) return;
    leaves.push_back({cell, std::span(tree.references).subspan(first_reference(node), reference_count(node))});
  });
  return leaves;
}

/// The triangle's plane if it is parallel to an axis plane, else -1.
int flat_axis(const std::array<Vec3u, 3>& t) {
  for (int axis = 0; axis < 3; ++axis) {
    if (t[0][axis] == t[1][axis] && t[0][axis] == t[2][axis]) return axis;
  }
  return -1;
}

/// Whether the corners of a flat box lie in the triangle, and so all of the box does.
bool contains(const std::array<Vec3u, 3>& t, const Box3u& face) {
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3u p{corner & 1 ? face.hi.x : face.lo.x, corner & 2 ? face.hi.y : face.lo.y,
                  corner & 4 ? face.hi.z : face.lo.z};
    if (!nkd::triangle_meets_box(t, {p, p}, false)) return false;
  }
  return true;
}

struct Faults {
  uint64_t missing = 0, foreign = 0, unordered = 0, dropped = 0, uncovered = 0;
};

Faults check(const Subject& s, const build::Tree& tree) {
  Faults faults;
  const std::vector<Leaf> leaves = leaves_of(tree, s.lattice);
  std::vector<uint32_t> referenced(s.shape.triangles.size(), 0);
  for (const Leaf& leaf : leaves) {
    faults.unordered += !std::is_sorted(leaf.references.begin(), leaf.references.end(), std::less_equal<>());
    Box3u wide = leaf.cell;
    for (int axis = 0; axis < 3; ++axis) {
      wide.lo.set(axis, std::max(wide.lo[axis], 1u) - 1);
      wide.hi.set(axis, wide.hi[axis] + 1);
    }
    for (uint32_t i : leaf.references) {
      ++referenced[i];
      faults.foreign += !nkd::triangle_meets_box(s.shape.corners(i), wide, false);
    }
  }
  for (uint32_t i = 0; i < s.shape.triangles.size(); ++i) {
    faults.dropped += referenced[i] == 0;
    const auto t = s.shape.corners(i);
    const int flat = flat_axis(t);
    for (const Leaf& leaf : leaves) {
      if (leaf.refers_to(i)) continue;
      const Box3u& cell = leaf.cell;
      bool solid = true;
      for (int axis = 0; axis < 3; ++axis) solid = solid && cell.lo[axis] < cell.hi[axis];
      if (solid) {
        faults.missing += nkd::triangle_meets_box(t, cell, true);
        if (flat < 0 || (t[0][flat] != cell.lo[flat] && t[0][flat] != cell.hi[flat])) continue;
      }
      if (flat < 0) continue;
      // The triangle lies in a face of the cell, or the cell is flat. Wherever it passes some leaf that touches its
      // plane there refers to it: those that do, as rectangles of the plane, leave none of this face uncovered.
      Box3u face = cell;
      if (t[0][flat] < cell.lo[flat] || t[0][flat] > cell.hi[flat]) continue;
      face.lo.set(flat, t[0][flat]);
      face.hi.set(flat, t[0][flat]);
      bool has_area = true;
      for (int axis = 0; axis < 3; ++axis) has_area = has_area && (axis == flat || face.lo[axis] < face.hi[axis]);
      if (!has_area || !nkd::triangle_meets_box(t, face, true)) continue;
      double covered = 0, area = 1;
      for (int axis = 0; axis < 3; ++axis) area *= axis == flat ? 1 : face.hi[axis] - face.lo[axis];
      for (const Leaf& other : leaves) {
        if (!other.refers_to(i) || other.cell.lo[flat] > t[0][flat] || other.cell.hi[flat] < t[0][flat]) continue;
        double common = 1;
        for (int axis = 0; axis < 3; ++axis) {
          if (axis == flat) continue;
          const double lo = std::max(face.lo[axis], other.cell.lo[axis]);
          const double hi = std::min(face.hi[axis], other.cell.hi[axis]);
          common *= std::max(hi - lo, 0.0);
        }
        covered += common;
      }
      faults.uncovered += covered == 0 || (contains(t, face) && covered < area);
    }
  }
  return faults;
}

void expect_sound(const Subject& s, const build::BuildSettings& settings) {
  CAPTURE(s.name);
  CAPTURE(s.lattice.bits);
  const Faults f = check(s, tree_of(s, settings));
  CHECK(f.missing == 0);
  CHECK(f.foreign == 0);
  CHECK(f.unordered == 0);
  CHECK(f.dropped == 0);
  CHECK(f.uncovered == 0);
}

}  // namespace

TEST_CASE("coverage: every leaf against every triangle") {
  for (const int bits : {6, 10, 21, 24}) {
    for (const Subject& s : small_subjects(bits)) expect_sound(s, {});
  }
}

TEST_CASE("coverage: trees that split for the sake of splitting") {
  for (const int bits : {6, 21}) {
    for (const Subject& s : small_subjects(bits)) {
      if (s.shape.triangles.size() < 500) expect_sound(s, {{0.05, 1.5, 0.05}, 24});
    }
  }
}

TEST_CASE("coverage: real meshes, down to where a triangle meets a cell") {
  for (const char* name : {"bunny.ply", "sibenik.ply"}) {
    const auto s = shared_mesh(name, 21);
    if (!s) {
      MESSAGE("skipped: no " << name);
      continue;
    }
    CAPTURE(name);
    const build::Tree tree = tree_of(*s);
    // From the root down, only into cells that the closed triangle meets: a leaf elsewhere cannot matter.
    uint64_t missing = 0, dropped = 0;
    for (uint32_t i = 0; i < s->shape.triangles.size(); ++i) {
      const auto t = s->shape.corners(i);
      bool referenced = false;
      std::vector<std::pair<uint32_t, Box3u>> open{{0, s->lattice.cube()}};
      while (!open.empty()) {
        const auto [index, cell] = open.back();
        open.pop_back();
        const Node node = tree.nodes[index];
        if (!is_leaf(node)) {
          const int axis = split_axis(node);
          const auto plane = static_cast<uint32_t>(split_plane(node));
          Box3u low = cell, high = cell;
          low.hi.set(axis, plane);
          high.lo.set(axis, plane);
          if (nkd::triangle_meets_box(t, low, false)) open.emplace_back(child_of(node, 0), low);
          if (nkd::triangle_meets_box(t, high, false)) open.emplace_back(child_of(node, 1), high);
          continue;
        }
        const auto begin = tree.references.begin() + first_reference(node);
        const bool known = std::binary_search(begin, begin + reference_count(node), i);
        referenced = referenced || known;
        bool solid = true;
        for (int axis = 0; axis < 3; ++axis) solid = solid && cell.lo[axis] < cell.hi[axis];
        missing += !known && solid && nkd::triangle_meets_box(t, cell, true);
      }
      dropped += !referenced;
    }
    CHECK(missing == 0);
    CHECK(dropped == 0);
  }
}

TEST_CASE("coverage: triangles in split planes are met by rays through all of them") {
  for (const int bits : {10, 21, 24}) {
    for (const Shape& shape : {rooms_shape(bits, 5, 6), stacked_boxes_shape(bits, 4)}) {
      CAPTURE(bits);
      const Traced traced(shape, bits);
      Random random(1);
      uint32_t wrong = 0, hits = 0;
      for (size_t i = 0; i < shape.triangles.size(); ++i) {
        const auto t = shape.corners(i);
        const Vec3d centre = (vec_cast<double>(t[0]) + vec_cast<double>(t[1]) + vec_cast<double>(t[2])) * (1.0 / 3);
        for (int k = 0; k < 12; ++k) {
          Vec3d d = k < 6 ? Vec3d{0, 0, 0} : random.vector(1);
          if (k < 6) d.set(k / 2, k % 2 ? 1 : -1);
          LatticeRay ray;
          // From just before it, so that it is the nearest, and from outside.
          const double back = k % 2 ? 0.01 * lattice_max(bits) : 2.0 * lattice_max(bits);
          if (!snap_ray(centre - d * back, d, 0, 1e300, bits, ray)) continue;
          NoCounter counter;
          const uint32_t met = traverse<RayMode::closest>(traced.view(), ray, 1e30f, kNoTriangle, counter);
          wrong += met != brute_force(traced.triangles, ray, 1e30f, kNoTriangle);
          hits += met != kNoTriangle;
        }
      }
      CHECK(wrong == 0);
      CHECK(hits > 8 * shape.triangles.size());
    }
  }
}
