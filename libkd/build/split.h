// The best split of a cell, by a sweep over its sorted events.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "build/events.h"
#include "core/box.h"
#include "core/sah.h"

namespace kd::build {

struct Split {
  double cost = std::numeric_limits<double>::infinity();
  int axis = -1;
  uint32_t plane = 0;
  bool flat_left = false;  // triangles that lie in the plane go to the left cell
};

/// Cheaper first; equal costs by axis and plane, so that the choice depends on no order of evaluation.
inline bool better(const Split& a, const Split& b) {
  if (a.cost != b.cost) return a.cost < b.cost;
  return a.axis != b.axis ? a.axis < b.axis : a.plane < b.plane;
}

/// The cheapest split of `cell` along `axis`, whose `count` triangles have these sorted events, or only the events'
/// places; infinite cost if none makes progress. `step` is the lattice's, in model units: areas are measured where rays
/// are.
Split best_split(std::span<const Event> events, int axis, const Box3u& cell, uint32_t count, Vec3d step,
                 const SahCosts& costs);
Split best_split(std::span<const EventPlace> places, int axis, const Box3u& cell, uint32_t count, Vec3d step,
                 const SahCosts& costs);

}  // namespace kd::build
