// The best split of a cell, by a sweep over its sorted events.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "build/context.h"
#include "build/cost.h"
#include "build/events.h"

namespace kd::build {

struct Split {
  double cost = std::numeric_limits<double>::infinity();
  int axis = -1;
  uint32_t plane = 0;
  bool flat_below = false;        // triangles that lie in the plane go to the lower cell
  uint32_t below = 0, above = 0;  // triangles on either side; those that pass through the plane count on both

  bool found() const { return axis >= 0; }
  EmptyChildren empty() const { return below == 0 ? kLowerEmpty : above == 0 ? kUpperEmpty : kNoneEmpty; }
};

/// Cheaper first; equal costs by axis and plane, so that the choice depends on no order of evaluation.
inline bool better(const Split& a, const Split& b) {
  if (a.cost != b.cost) return a.cost < b.cost;
  return a.axis != b.axis ? a.axis < b.axis : a.plane < b.plane;
}

/// The cheapest split of `cell` along `axis`, whose `count` triangles have these sorted events; none is found if none
/// makes progress.
Split best_split(const Context& context, std::span<const Event> events, int axis, const Box3u& cell, uint32_t count);

/// Whether a cell of `count` triangles is better split like this than left a leaf. Counts are taken as they are, not as
/// ExpectedTests has them: else a heap of triangles that no plane can part would be split without end.
bool pays(const Context& context, const Box3u& cell, uint32_t count, const Split& split);

}  // namespace kd::build
