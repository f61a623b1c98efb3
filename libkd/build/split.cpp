#include "build/split.h"

namespace kd::build {

namespace {

/// Probabilities that a ray which meets the cell meets its part below or above a plane across one axis.
class PlaneProbability {
 public:
  PlaneProbability(const Box3u& cell, int axis, Vec3d step)
      : lo_(cell.lo[axis]), hi_(cell.hi[axis]), step_(step[axis]) {
    const Vec3d edges = vec_cast<double>(cell.extent()) * step;
    const double e1 = edges[(axis + 1) % 3], e2 = edges[(axis + 2) % 3];
    const double area = half_area(edges);
    constant_ = area > 0 ? e1 * e2 / area : 1;
    per_length_ = area > 0 ? (e1 + e2) / area : 0;
  }
  double below(uint32_t plane) const { return constant_ + per_length_ * (plane - lo_) * step_; }
  double above(uint32_t plane) const { return constant_ + per_length_ * (hi_ - plane) * step_; }

 private:
  double lo_, hi_, step_;
  double constant_;    // of the face across the axis
  double per_length_;  // of the sides, per unit of length along the axis
};

template <class EventOrPlace>
Split sweep(std::span<const EventOrPlace> events, int axis, const Box3u& cell, uint32_t count, Vec3d step,
            const SahCosts& costs) {
  Split best;
  const uint32_t lo = cell.lo[axis], hi = cell.hi[axis];
  if (lo == hi) return best;
  const PlaneProbability probability(cell, axis, step);

  const auto consider = [&](uint32_t plane, uint32_t n_left, uint32_t n_right, bool flat_left) {
    const double cost = split_cost(costs, probability.below(plane), probability.above(plane), n_left, n_right);
    if (cost < best.cost) best = {cost, axis, plane, flat_left};
  };

  uint32_t left = 0, right = count;
  for (size_t i = 0; i < events.size();) {
    const uint32_t plane = plane_of(events[i]);
    uint32_t ends = 0, flats = 0, starts = 0;
    for (; i < events.size() && plane_of(events[i]) == plane; ++i) {
      const EventKind kind = kind_of(events[i]);
      ends += kind == EventKind::end;
      flats += kind == EventKind::flat;
      starts += kind == EventKind::start;
    }
    right -= ends + flats;
    if (plane > lo && plane < hi) {
      consider(plane, left + flats, right, true);
      if (flats > 0) consider(plane, left, right + flats, false);
    } else if (flats > 0 && flats < count) {
      // At the cell's own face a split is progress if it puts the triangles in the face into a flat cell of their own.
      if (plane == lo) consider(plane, flats, right, true);
      if (plane == hi) consider(plane, left, flats, false);
    }
    left += starts + flats;
  }
  return best;
}

}  // namespace

Split best_split(std::span<const Event> events, int axis, const Box3u& cell, uint32_t count, Vec3d step,
                 const SahCosts& costs) {
  return sweep(events, axis, cell, count, step, costs);
}

Split best_split(std::span<const EventPlace> places, int axis, const Box3u& cell, uint32_t count, Vec3d step,
                 const SahCosts& costs) {
  return sweep(places, axis, cell, count, step, costs);
}

}  // namespace kd::build
