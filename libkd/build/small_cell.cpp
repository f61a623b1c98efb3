#include "build/small_cell.h"

#include <algorithm>
#include <span>

#include "build/bisection.h"
#include "build/cost.h"
#include "build/split.h"
#include "core/lanes.h"

namespace kd::build {

namespace {

Floats expected_tests(Floats n) {
  Floats tests = n;
  for (size_t i = 1; i <= 3; ++i) {  // up to 8 * kLinear
    const auto& line = ExpectedTests::kLines[i];
    tests = least(tests, static_cast<float>(line.intercept) + static_cast<float>(line.slope) * n);
  }
  return tests;
}
static_assert(kSmallCell <= 8 * ExpectedTests::kLinear);

/// The best split seen so far in each of eight lanes.
struct Best {
  Floats cost = splat(std::numeric_limits<float>::infinity());
  Ints plane{}, below{}, above{}, kind{};  // kind: axis << 1 | flat_below

  void consider(Floats c, Ints p, Ints b, Ints a, int k) {
    const Ints lower = c < cost;
    cost = lower ? c : cost;
    plane = lower ? p : plane;
    below = lower ? b : below;
    above = lower ? a : above;
    kind = lower ? splat(k) : kind;
  }
  Split split() const {
    int best = 0;
    for (int i = 1; i < kLanes; ++i) {
      if (cost[i] < cost[best]) best = i;
    }
    Split s;
    if (!(cost[best] < std::numeric_limits<float>::infinity())) return s;
    return {cost[best],
            kind[best] >> 1,
            static_cast<uint32_t>(plane[best]),
            (kind[best] & 1) != 0,
            static_cast<uint32_t>(below[best]),
            static_cast<uint32_t>(above[best])};
  }
};

/// The prices and probabilities of one cell and axis, eight times.
struct LaneCosts {
  float traversal, intersection, kept, reference_bytes, node_bytes;
  float constant, per_step;
  int32_t lo, hi;

  LaneCosts(const CellCosts& c, const PlaneProbability& p, const Box3u& cell, int axis)
      : traversal(static_cast<float>(c.traversal)),
        intersection(static_cast<float>(c.intersection)),
        kept(static_cast<float>(c.kept)),
        reference_bytes(static_cast<float>(c.byte * kReferenceBytes)),
        node_bytes(static_cast<float>(c.byte * kNodeBytes)),
        constant(static_cast<float>(p.constant)),
        per_step(static_cast<float>(p.per_step)),
        lo(static_cast<int32_t>(cell.lo[axis])),
        hi(static_cast<int32_t>(cell.hi[axis])) {}

  Floats split(Ints plane, Ints below, Ints above) const {
    const Floats n_below = to_floats(below), n_above = to_floats(above);
    const Floats p_below = constant + per_step * to_floats(plane - lo);
    const Floats p_above = constant + per_step * to_floats(hi - plane);
    const Floats sah =
        traversal + intersection * (p_below * expected_tests(n_below) + p_above * expected_tests(n_above));
    const Floats bytes = reference_bytes * (n_below + n_above) + 2 * node_bytes;
    const Ints one_empty = (below == 0) | (above == 0);
    return one_empty ? kept * sah + bytes : sah + (bytes + node_bytes);
  }
};

/// Planes to consider: where boxes begin and end inside the cell, and its faces if a triangle lies in them.
struct Candidates {
  alignas(32) int32_t planes[2 * kSmallCell + kLanes];
  size_t count = 0;
  bool flats = false;  // some triangles lie across the axis

  void add_if(bool wanted, int32_t plane) {
    planes[count] = plane;
    count += wanted;
  }
  Candidates(const int32_t* lo, const int32_t* hi, size_t n, int32_t cell_lo, int32_t cell_hi) {
    bool flat = false;
    for (size_t i = 0; i < n; ++i) {
      add_if(lo[i] > cell_lo, lo[i]);
      add_if(hi[i] < cell_hi, hi[i]);
      flat |= lo[i] == hi[i];
    }
    flats = flat;
    for (size_t i = count; i % kLanes != 0; ++i) planes[i] = count > 0 ? planes[0] : cell_lo;
  }
};

/// The cheapest split of the cell, by counting: of each candidate plane, the boxes that reach below and above it.
Split choose_split(const Context& context, const CellCosts& costs, const Box3u& cell, const BoxStack& stack,
                   size_t first, size_t n) {
  Best best;
  for (int axis = 0; axis < 3; ++axis) {
    if (cell.lo[axis] == cell.hi[axis]) continue;
    const BoxStack::Interval& boxes = stack.axes[static_cast<size_t>(axis)];
    const int32_t *lo = boxes.lo.data() + first, *hi = boxes.hi.data() + first;
    const LaneCosts lane_costs(costs, PlaneProbability(cell, axis, context.step), cell, axis);
    const Candidates candidates(lo, hi, n, lane_costs.lo, lane_costs.hi);
    for (size_t c = 0; c < candidates.count; c += kLanes) {
      const Ints plane = load_lanes(candidates.planes + c);
      Ints below{}, above{};
      for (size_t i = 0; i < n; ++i) {
        below -= splat(lo[i]) < plane;
        above -= splat(hi[i]) > plane;
      }
      if (!candidates.flats) {
        best.consider(lane_costs.split(plane, below, above), plane, below, above, axis << 1);
        continue;
      }
      Ints flat{};
      for (size_t i = 0; i < n; ++i) flat -= (splat(lo[i]) == plane) & (splat(hi[i]) == plane);
      // At the cell's own face a split puts the triangles in the face into a flat cell of their own.
      const Floats never = splat(std::numeric_limits<float>::infinity());
      const Floats with_below = lane_costs.split(plane, below + flat, above);
      const Floats with_above = lane_costs.split(plane, below, above + flat);
      best.consider(plane == lane_costs.hi ? never : with_below, plane, below + flat, above, axis << 1 | 1);
      best.consider(plane == lane_costs.lo ? never : with_above, plane, below, above + flat, axis << 1);
    }
  }
  return best.split();
}

class SmallCellBuilder {
 public:
  SmallCellBuilder(const Context& context, BoxStack& stack, Subtree& out)
      : context_(context), stack_(stack), out_(out) {}

  /// What a subtree came to.
  struct Outcome {
    double cost = 0;   // expected, to a ray that meets the cell
    double bytes = 0;  // of nodes and references
  };
  Outcome build(const Box3u& cell, int depth, int bisections, size_t first, uint32_t slot);

 private:
  bool gains(const Box3u& cell, const CellCosts& costs, uint32_t count, const Split& split) const;
  void make_leaf_of(size_t first, size_t n, uint32_t slot);
  size_t push_children(const Box3u& cell, const Split& split, bool boxes_matter, size_t first, size_t n);
  void push_copy(size_t from);

  const Context& context_;
  BoxStack& stack_;
  Subtree& out_;
};

void SmallCellBuilder::make_leaf_of(size_t first, size_t n, uint32_t slot) {
  const auto count = static_cast<uint32_t>(n);
  out_.nodes[slot] = make_leaf(static_cast<uint32_t>(out_.references.size()), count);
  const auto begin = stack_.triangles.begin() + static_cast<std::ptrdiff_t>(first);
  out_.references.insert(out_.references.end(), begin, begin + count);
}

void SmallCellBuilder::push_copy(size_t from) {
  for (BoxStack::Interval& axis : stack_.axes) {
    axis.lo[stack_.size] = axis.lo[from];
    axis.hi[stack_.size] = axis.hi[from];
  }
  stack_.triangles[stack_.size++] = stack_.triangles[from];
}

/// Pushes the triangles of the upper child, then those of the lower one, and returns where the latter begin. Triangles
/// on both sides are clipped, unless neither child will look at its boxes.
size_t SmallCellBuilder::push_children(const Box3u& cell, const Split& split, bool boxes_matter, size_t first,
                                       size_t n) {
  const auto plane = static_cast<int32_t>(split.plane);
  const BoxStack::Interval& along = stack_.axes[static_cast<size_t>(split.axis)];
  stack_.reserve(2 * n);
  std::array<Box3u, kSmallCell> lower_boxes;
  size_t clipped = 0;
  for (size_t i = first; i < first + n; ++i) {
    const int32_t lo = along.lo[i], hi = along.hi[i];
    if (lo == hi && lo == plane ? split.flat_below : hi <= plane) continue;
    if (lo >= plane || !boxes_matter) {
      push_copy(i);
      continue;
    }
    const SplitBounds parts = split_bounds(context_.corners(stack_.triangles[i]), cell, split.axis, split.plane);
    lower_boxes[clipped++] = parts.below;
    if (!parts.above.empty()) stack_.push(stack_.triangles[i], parts.above);
  }
  const size_t lower_first = stack_.size;
  clipped = 0;
  for (size_t i = first; i < first + n; ++i) {
    const int32_t lo = along.lo[i], hi = along.hi[i];
    if (lo == hi && lo == plane ? !split.flat_below : lo >= plane) continue;
    if (hi <= plane || !boxes_matter) {
      push_copy(i);
      continue;
    }
    const Box3u& part = lower_boxes[clipped++];
    if (!part.empty()) stack_.push(stack_.triangles[i], part);
  }
  return lower_first;
}

bool SmallCellBuilder::gains(const Box3u& cell, const CellCosts& costs, uint32_t count, const Split& split) const {
  return split.cost < costs.leaf(count) && (count <= ExpectedTests::kLinear || pays(context_, cell, count, split));
}

SmallCellBuilder::Outcome SmallCellBuilder::build(const Box3u& cell, int depth, int bisections, size_t first,
                                                  uint32_t slot) {
  const size_t n = stack_.size - first;
  const auto count = static_cast<uint32_t>(n);
  const CellCosts costs(context_, cell, count);
  const auto close = [&] {
    make_leaf_of(first, n, slot);
    stack_.size = first;
    return Outcome{costs.intersection * count, leaf_bytes(count)};
  };
  if (costs.hopeless(count) || depth >= context_.max_depth) return close();
  Split split = choose_split(context_, costs, cell, stack_, first, n);
  const bool bisected = !gains(cell, costs, count, split);
  if (bisected) split = bisections < kMostBisections ? bisection(context_, cell, stack_, first) : Split{};
  if (!split.found()) return close();

  Box3u below = cell, above = cell;
  below.hi.set(split.axis, split.plane);
  above.lo.set(split.axis, split.plane);
  const bool boxes_matter = !CellCosts(context_, below, split.below).hopeless(split.below) ||
                            !CellCosts(context_, above, split.above).hopeless(split.above);
  const size_t lower_first = push_children(cell, split, boxes_matter, first, n);

  const size_t nodes_before = out_.nodes.size(), references_before = out_.references.size();
  const uint32_t child = out_.open_inner(slot, split);
  const PlaneProbability probability(cell, split.axis, context_.step);
  Outcome outcome{costs.traversal, kNodeBytes};
  const auto add = [&](const Outcome& part, double share) {
    outcome.cost += share * part.cost;
    outcome.bytes += part.bytes;
  };
  if (split.below > 0)
    add(build(below, depth + 1, bisections + bisected, lower_first, child), probability.below(split.plane));
  if (split.above > 0)
    add(build(above, depth + 1, bisections + bisected, first + n, child + 1), probability.above(split.plane));
  if (outcome.cost + costs.byte * outcome.bytes < (bisected ? kWorthBisecting : 1) * costs.leaf(count)) {
    stack_.size = first;
    return outcome;
  }
  out_.nodes.resize(nodes_before);
  out_.references.resize(references_before);
  return close();
}

}  // namespace

void build_small_cell(const Context& context, const Box3u& cell, int depth, int bisections, BoxStack& stack,
                      size_t first, uint32_t slot, Subtree& out) {
  SmallCellBuilder(context, stack, out).build(cell, depth, bisections, first, slot);
}

}  // namespace kd::build
