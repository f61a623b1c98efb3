#include "build/bisection.h"

#include "build/clip.h"
#include "build/cost.h"

namespace kd::build {

namespace {

/// The triangles on one side of a plane.
struct Half {
  uint32_t count = 0;
  Box3u box;  // of their parts there

  void add(const Box3u& part) {
    if (part.empty()) return;
    ++count;
    box.extend(part);
  }
};

}  // namespace

Split bisection(const Context& context, const Box3u& cell, const BoxStack& stack, size_t first) {
  Split best;
  const size_t n = stack.size - first;
  const double area = context.half_area_of(cell);
  if (n <= CellCosts::kFullLeaf || !(area > 0)) return best;
  const CellCosts costs(context, cell, static_cast<uint32_t>(n));
  for (int axis = 0; axis < 3; ++axis) {
    const uint32_t lo = cell.lo[axis], hi = cell.hi[axis], plane = lo + (hi - lo) / 2;
    if (plane == lo) continue;
    Half below, above;
    for (size_t i = first; i < stack.size; ++i) {
      const Box3u box = stack.box(i);
      if (box.hi[axis] <= plane) {
        below.add(box);
      } else if (box.lo[axis] >= plane) {
        above.add(box);
      } else {
        const SplitBounds parts = split_bounds(context.corners(stack.triangles[i]), cell, axis, plane);
        below.add(parts.below);
        above.add(parts.above);
      }
    }
    const PlaneProbability probability(cell, axis, context.step);
    const auto expected = [&](const Half& half, double met) {
      if (half.count == 0) return 0.0;
      return met * costs.traversal + context.half_area_of(half.box) / area * (costs.intersection * half.count);
    };
    const double cost = costs.traversal + expected(below, probability.below(plane)) +
                        expected(above, probability.above(plane)) + costs.bytes_of(below.count, above.count);
    const Split split{cost, axis, plane, true, below.count, above.count};
    if (better(split, best)) best = split;
  }
  return best.cost < costs.leaf(static_cast<uint32_t>(n)) ? best : Split{};
}

}  // namespace kd::build
