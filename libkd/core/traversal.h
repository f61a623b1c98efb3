// Front-to-back traversal of one object's kd-tree that cannot skip a cell it touches.
//
// A hit counts wherever on the ray it lies, not only inside the leaf's own interval: a triangle in a split plane, or
// one reached through a cell a few ulps thin, is found whichever of its leaves comes first. Traversal ends when the
// nearest hit so far lies before the next cell's entry.
//
// Why no cell is lost. With e = 2^-24, plane - origin is exact, so the computed distance s of a plane obeys
// |s - S| <= 2.1 e |S| for the exact distance S. A cell's exit is kept with a margin, s (1 + 8e), which is at least
// S (1 + 5e) where S > 0; its entry is kept as computed, and compared with the plane's distance plus that margin.
// Therefore
//   s > exit              means S > S_exit:   the far child is certainly beyond the cell;
//   s (1 + 8e) < entry    means S < S_entry:  the near child is certainly behind it;
// and otherwise the child is visited. An entry that comes from the stack is an exit, so the margin is taken off again.
//
// Of the hits the nearest in double counts, not in float32: a ray that clips the edge of a convex body enters by one
// face and leaves by another within a millionth of a step, and a shadow ray from the wrong one would start inside.
// Cells are left out against that distance rounded up, so "nearest hit before the entry" is never said too early.
#pragma once

#include "core/arithmetic.h"
#include "core/lattice_ray.h"
#include "core/object_view.h"
#include "core/triangle.h"

namespace kd {

constexpr uint32_t kNoTriangle = 0xffffffffu;

namespace detail {

constexpr float kMargin = 1 + 0x1p-21f;        // 8e: (1 - 2.1e)(1 + 8e) > 1 + 5e
constexpr float kResumeMargin = 1 - 0x1p-20f;  // 16e, of an exit, which is at most S (1 + 11e)

struct StackEntry {
  uint32_t node;
  float s_exit;
};

/// Where a ray is on its way through a tree.
struct Way {
  float s_entry;   // where it enters the cell it is in
  float s_exit;    // and leaves it
  float s_resume;  // where the cell on top of the stack begins; never beyond where the one below it does
};

/// A step down, for a ray of which `origin` and `inverse` are the components along the node's axis: the index of the
/// child that it meets first, kEmptyLeaf if it meets none. Of two it meets, remember(far) gets the other, which ends
/// where the cell did: way.s_exit, not yet changed.
template <class Remember>
KD_HD KD_INLINE uint32_t step_down(Node node, float origin, float inverse, Way& way, Remember&& remember) {
  const float s = (split_plane(node) - origin) * inverse, s_more = s * kMargin;
  // Integer arithmetic in place of branches: on a GPU, lanes that part over a node take longer than any of its
  // cases. Empty children are neither visited nor remembered.
  const uint32_t down = std::bit_cast<uint32_t>(inverse) >> 31;
  const uint32_t near = first_child(node) + down, far = first_child(node) + 1 - down;
  const uint32_t near_empty = kLowerEmpty << down, far_empty = near_empty ^ (kLowerEmpty | kUpperEmpty);
  const bool to_near = s_more >= way.s_entry && (node.link & near_empty) == 0;
  const bool to_far = s <= way.s_exit && (node.link & far_empty) == 0;
  if (to_near && to_far) {
    remember(far);
    way.s_resume = least_of(way.s_exit, s_more);
  }
  if (to_near) way.s_exit = least_of(way.s_exit, s_more);
  if (!to_near) way.s_entry = largest_of(way.s_entry, s);
  return to_near ? near : to_far ? far : kEmptyLeaf;
}

}  // namespace detail

/// The triangle the ray meets first within [s_min, min(s_max, s_limit)], or with RayMode::any some triangle it meets
/// there. Returns kNoTriangle if there is none. Of two triangles at the same distance (as Test::meets tells it) the
/// lower index wins, so the answer depends on no order of visits. `excluded`: a triangle that is never met (a shadow
/// ray's own), or kNoTriangle.
template <RayMode mode, class Test = ExactTest, TriangleLayout layout = TriangleLayout::expanded, class Counter>
KD_HD inline uint32_t traverse(const ObjectView& object, const LatticeRay& ray, float s_limit, uint32_t excluded,
                               Counter& counter) {
  using namespace detail;
  const Test test{ray};
  StackEntry stack[kMaxDepth];
  int depth = 0;
  uint32_t best = kNoTriangle;
  float s_best = min_of(ray.s_max, s_limit);  // `nearest`, rounded up
  typename Test::Distance nearest = s_best;

  const float s_out = min_of(ray.s_exit, s_best) * kMargin;
  Way way{ray.s_min, s_out, s_out};
  Node node = load(object.nodes);

  while (true) {
    while (!is_leaf(node)) {
      counter.node();
      const int axis = split_axis(node);
      const uint32_t next = step_down(node, ray.origin[axis], ray.inverse[axis], way, [&](uint32_t far) {
        stack[depth] = {far, way.s_exit};
        ++depth;
      });
      node = load(object.nodes + next);
    }

    counter.leaf();
    const uint32_t begin = first_reference(node), end = begin + reference_count(node);
    for (uint32_t r = begin; r < end; ++r) {
      const uint32_t candidate = object.references[r];
      counter.triangle();
      typename Test::Distance s;
      if (candidate == excluded) continue;
      if (!test.template meets<mode>(object.triangle<layout>(candidate), s_best, s, counter)) continue;
      if (s < ray.s_min || s > nearest) continue;
      if constexpr (mode == RayMode::any) return candidate;
      if (s < nearest || candidate < best) {
        nearest = s;
        s_best = rounded_up(s);
        best = candidate;
      }
    }

    if (depth == 0) return best;
    // Beyond the nearest hit there is nothing left to find.
    way.s_entry = way.s_resume * kResumeMargin;
    if (s_best < way.s_entry) return best;
    --depth;
    way.s_resume = way.s_exit = stack[depth].s_exit;
    node = load(object.nodes + stack[depth].node);
  }
}

}  // namespace kd
