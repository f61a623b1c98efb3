#include "build/small_cell.h"

#include <algorithm>
#include <span>

#include "build/split.h"

namespace kd::build {

namespace {

size_t collect_places(std::span<const BoxedTriangle> triangles, int axis, EventPlace* places) {
  size_t count = 0;
  for (const BoxedTriangle& t : triangles) {
    const uint32_t lo = t.box.lo[axis], hi = t.box.hi[axis];
    if (lo == hi) {
      places[count++] = make_place(lo, EventKind::flat);
    } else {
      places[count++] = make_place(lo, EventKind::start);
      places[count++] = make_place(hi, EventKind::end);
    }
  }
  std::sort(places, places + count);
  return count;
}

Split choose_split(const Context& context, const Box3u& cell, std::span<const BoxedTriangle> triangles) {
  EventPlace places[2 * kSmallCell];
  const auto n = static_cast<uint32_t>(triangles.size());
  Split best;
  for (int axis = 0; axis < 3; ++axis) {
    if (cell.lo[axis] == cell.hi[axis]) continue;
    const size_t count = collect_places(triangles, axis, places);
    const Split split =
        best_split(std::span<const EventPlace>(places, count), axis, cell, n, context.step, context.costs);
    if (better(split, best)) best = split;
  }
  return best;
}

/// Copies to the top of the stack what of the triangles [first, end) belongs to one child.
void push_child(const Context& context, const Box3u& child, const Split& split, bool below,
                std::vector<BoxedTriangle>& stack, size_t first, size_t end) {
  for (size_t i = first; i < end; ++i) {
    BoxedTriangle t = stack[i];
    const uint32_t lo = t.box.lo[split.axis], hi = t.box.hi[split.axis];
    const bool in_plane = lo == split.plane && hi == split.plane;
    const bool only_below = in_plane ? split.flat_left : hi <= split.plane;
    const bool only_above = in_plane ? !split.flat_left : lo >= split.plane;
    if (below ? only_above : only_below) continue;
    if (!only_below && !only_above) {
      const auto clipped = clipped_bounds(context.corners(t.triangle), child);
      if (!clipped) continue;
      t.box = *clipped;
    }
    stack.push_back(t);
  }
}

double make_leaf_of(const Context& context, std::span<const BoxedTriangle> triangles, uint32_t slot, Subtree& out) {
  const auto count = static_cast<uint32_t>(triangles.size());
  out.nodes[slot] = make_leaf(static_cast<uint32_t>(out.references.size()), count);
  for (const BoxedTriangle& t : triangles) out.references.push_back(t.triangle);
  return context.leaf_cost(count);
}

/// The probability that a ray which meets `cell` meets `child`.
double probability(const Box3u& child, const Box3u& cell, Vec3d step) {
  const double area = half_area(vec_cast<double>(cell.extent()) * step);
  return area > 0 ? half_area(vec_cast<double>(child.extent()) * step) / area : 1;
}

}  // namespace

double build_small_cell(const Context& context, const Box3u& cell, int depth, std::vector<BoxedTriangle>& stack,
                        size_t first, uint32_t slot, Subtree& out) {
  const size_t end = stack.size();
  const auto triangles = [&] { return std::span<const BoxedTriangle>(stack).subspan(first, end - first); };
  const auto count = static_cast<uint32_t>(end - first);
  const double leaf_cost = context.leaf_cost(count);
  const Split split = count > 0 && depth < context.max_depth ? choose_split(context, cell, triangles()) : Split{};
  if (split.cost >= leaf_cost) {
    const double cost = make_leaf_of(context, triangles(), slot, out);
    stack.resize(first);
    return cost;
  }

  const size_t nodes_before = out.nodes.size(), references_before = out.references.size();
  const uint32_t pair = out.open_inner(slot, split.axis, split.plane);
  double cost = context.costs.traversal;
  const auto descend = [&](const Box3u& child, bool below, uint32_t child_slot) {
    push_child(context, child, split, below, stack, first, end);
    cost += probability(child, cell, context.step) *
            build_small_cell(context, child, depth + 1, stack, end, child_slot, out);
  };
  Box3u below = cell, above = cell;
  below.hi.set(split.axis, split.plane);
  above.lo.set(split.axis, split.plane);
  descend(below, true, pair);
  descend(above, false, pair + 1);
  if (cost >= leaf_cost) {
    out.nodes.resize(nodes_before);
    out.references.resize(references_before);
    cost = make_leaf_of(context, triangles(), slot, out);
  }
  stack.resize(first);
  return cost;
}

}  // namespace kd::build
