#include "build/split.h"

namespace kd::build {

Split best_split(const Context& context, std::span<const Event> events, int axis, const Box3u& cell, uint32_t count) {
  Split best;
  const uint32_t lo = cell.lo[axis], hi = cell.hi[axis];
  if (lo == hi) return best;
  const PlaneProbability probability(cell, axis, context.step);
  const CellCosts costs(context, cell, count);

  const auto consider = [&](uint32_t plane, uint32_t below, uint32_t above, bool flat_below) {
    const double tests =
        probability.below(plane) * ExpectedTests::of(below) + probability.above(plane) * ExpectedTests::of(above);
    const double cost = costs.split(tests, below, above);
    if (cost < best.cost) best = {cost, axis, plane, flat_below, below, above};
  };

  uint32_t below = 0, above = count;
  for (size_t i = 0; i < events.size();) {
    const uint32_t plane = plane_of(events[i]);
    uint32_t ends = 0, flats = 0, starts = 0;
    for (; i < events.size() && plane_of(events[i]) == plane; ++i) {
      const EventKind kind = kind_of(events[i]);
      ends += kind == EventKind::end;
      flats += kind == EventKind::flat;
      starts += kind == EventKind::start;
    }
    above -= ends + flats;
    if (plane > lo && plane < hi) {
      consider(plane, below + flats, above, true);
      if (flats > 0) consider(plane, below, above + flats, false);
    } else if (flats > 0) {
      // At the cell's own face a split puts the triangles in the face into a flat cell of their own, even if they are
      // all that the cell has: rays that leave it by another face then need not test them.
      if (plane == lo) consider(plane, flats, above, true);
      if (plane == hi) consider(plane, below, flats, false);
    }
    below += starts + flats;
  }
  return best;
}

bool pays(const Context& context, const Box3u& cell, uint32_t count, const Split& split) {
  if (!split.found()) return false;
  const PlaneProbability probability(cell, split.axis, context.step);
  const CellCosts costs(context, cell, count);
  const double tests = probability.below(split.plane) * split.below + probability.above(split.plane) * split.above;
  return costs.split(tests, split.below, split.above) < costs.leaf(count);
}

}  // namespace kd::build
