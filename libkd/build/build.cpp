#include "build/build.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <numeric>
#include <utility>

#include "build/bisection.h"
#include "build/clip.h"
#include "build/context.h"
#include "build/events.h"
#include "build/small_cell.h"
#include "build/split.h"
#include "build/subtree.h"
#include "sys/parallel.h"

namespace kd::build {

namespace {

constexpr uint32_t kParallelSubtree = 2048;  // triangles from which two subtrees are built at once
constexpr uint32_t kParallelSweep = 16384;   // triangles from which the three axes of one cell are worked on at once

/// A cell on its way to becoming a node: its triangles, renumbered from 0, and their events along each axis.
struct Cell {
  Box3u box;
  std::vector<uint32_t> triangles;  // number in the cell -> number in the object, ascending
  std::array<EventList, 3> events;
  int depth = 0;
  int bisections = 0;  // of the cells it is in, and then its own
  double weight = 1;   // share of the whole build, for progress

  uint32_t count() const { return static_cast<uint32_t>(triangles.size()); }
};

/// Runs body(axis) for the three axes, at once if `parallel`.
template <class Body>
void for_each_axis(bool parallel, const Body& body) {
  if (parallel) {
    parallel_tasks([&] { body(0); }, [&] { body(1); }, [&] { body(2); });
  } else {
    for (int axis = 0; axis < 3; ++axis) body(axis);
  }
}

class Builder {
 public:
  Builder(const Context& context, const Progress& progress) : context_(context), progress_(progress) {}

  Cell root(const Lattice& lattice) const;
  void build(Cell cell, uint32_t slot, Subtree& out);
  bool cancelled() const { return cancelled_; }

 private:
  Split choose_split(const Cell& cell) const;
  std::pair<Cell, Cell> divide(const Cell& cell, const Split& split) const;
  Split find_split(Cell& cell);
  BoxStack& boxes_of(const Cell& cell);
  void build_small(const Cell& cell, uint32_t slot, Subtree& out);
  void report(double weight);

  const Context& context_;
  const Progress& progress_;
  PerThread<BoxStack> stacks_;
  std::mutex progress_mutex_;
  double done_ = 0;      // guarded by progress_mutex_
  double reported_ = 0;  // guarded by progress_mutex_
  std::atomic<bool> cancelled_ = false;
};

Cell Builder::root(const Lattice& lattice) const {
  Cell cell;
  cell.box = lattice.cube();
  const auto n = static_cast<uint32_t>(context_.triangles.size());
  cell.triangles.resize(n);
  std::iota(cell.triangles.begin(), cell.triangles.end(), 0u);
  for_each_axis(n >= kParallelSweep, [&](int axis) {
    EventList& events = cell.events[static_cast<size_t>(axis)];
    events.reserve(2 * size_t{n});
    for (uint32_t i = 0; i < n; ++i) append_events(bounds(context_.corners(i)), axis, i, events);
    sort_root_events(events, lattice.bits + 2);
  });
  return cell;
}

Split Builder::choose_split(const Cell& cell) const {
  std::array<Split, 3> candidates;
  for_each_axis(cell.count() >= kParallelSweep, [&](int axis) {
    const auto a = static_cast<size_t>(axis);
    candidates[a] = best_split(context_, cell.events[a], axis, cell.box, cell.count());
  });
  return std::min({candidates[0], candidates[1], candidates[2]}, better);
}

/// Where a parent's triangle goes: its number in the one child that has it, with the child's side in the lowest bit, or
/// kBoth if it is clipped and goes to either with events of its own.
constexpr uint32_t kBoth = 0xffffffffu;
enum Side : uint32_t { kBelow = 0, kAbove = 1 };

std::vector<uint32_t> classify(const EventList& events, uint32_t count, const Split& split) {
  std::vector<uint32_t> side(count, kBoth);
  for (Event e : events) {
    const uint32_t plane = plane_of(e), triangle = triangle_of(e);
    switch (kind_of(e)) {
      case EventKind::end:
        if (plane <= split.plane) side[triangle] = kBelow;
        break;
      case EventKind::start:
        if (plane >= split.plane) side[triangle] = kAbove;
        break;
      case EventKind::flat:
        side[triangle] = plane < split.plane || (plane == split.plane && split.flat_below) ? kBelow : kAbove;
        break;
    }
  }
  return side;
}

/// A clipped triangle's part in one child.
struct Part {
  uint32_t number;
  Box3u box;
};

/// One child's events along an axis in the making: the parent's, which arrive in order, merged with those of the
/// clipped triangles.
class Merge {
 public:
  Merge(EventList& out, const std::vector<Part>& parts, int axis, size_t count) : out_(out) {
    fresh_.reserve(2 * parts.size() + 1);
    for (const Part& part : parts) append_events(part.box, axis, part.number, fresh_);
    std::sort(fresh_.begin(), fresh_.end());
    fresh_.push_back(~Event{0});
    next_ = fresh_.data();
    out_.reserve(2 * count);
  }
  void put(Event e) {
    while (*next_ < e) out_.push_back(*next_++);
    out_.push_back(e);
  }
  void finish() { out_.insert(out_.end(), next_, static_cast<const Event*>(&fresh_.back())); }

 private:
  EventList& out_;
  EventList fresh_;  // ends with a sentinel
  const Event* next_;
};

std::pair<Cell, Cell> Builder::divide(const Cell& cell, const Split& split) const {
  std::vector<uint32_t> target = classify(cell.events[static_cast<size_t>(split.axis)], cell.count(), split);
  std::array<Cell, 2> children;
  for (Cell& child : children) {
    child.box = cell.box;
    child.depth = cell.depth + 1;
    child.bisections = cell.bisections;
  }
  children[kBelow].box.hi.set(split.axis, split.plane);
  children[kAbove].box.lo.set(split.axis, split.plane);
  children[kBelow].triangles.reserve(split.below);
  children[kAbove].triangles.reserve(split.above);

  std::array<std::vector<Part>, 2> parts;
  for (uint32_t i = 0; i < cell.count(); ++i) {
    const uint32_t triangle = cell.triangles[i];
    const auto append = [&](Side side) {
      children[side].triangles.push_back(triangle);
      return children[side].count() - 1;
    };
    if (target[i] != kBoth) {
      const auto side = static_cast<Side>(target[i]);
      target[i] = append(side) << 1 | side;
      continue;
    }
    const SplitBounds clipped = split_bounds(context_.corners(triangle), cell.box, split.axis, split.plane);
    if (!clipped.below.empty()) parts[kBelow].push_back({append(kBelow), clipped.below});
    if (!clipped.above.empty()) parts[kAbove].push_back({append(kAbove), clipped.above});
  }

  for_each_axis(cell.count() >= kParallelSweep, [&](int axis) {
    const auto a = static_cast<size_t>(axis);
    Merge below(children[kBelow].events[a], parts[kBelow], axis, children[kBelow].count());
    Merge above(children[kAbove].events[a], parts[kAbove], axis, children[kAbove].count());
    for (Event e : cell.events[a]) {
      const uint32_t to = target[triangle_of(e)];
      if (to == kBoth) continue;
      (to & 1 ? above : below).put(renumbered(e, to >> 1));
    }
    below.finish();
    above.finish();
  });
  const double total = children[kBelow].count() + children[kAbove].count();
  children[kBelow].weight = total > 0 ? cell.weight * children[kBelow].count() / total : 0;
  children[kAbove].weight = cell.weight - children[kBelow].weight;
  return {std::move(children[kBelow]), std::move(children[kAbove])};
}

/// The boxes that the cell's events describe, alone on this thread's stack.
BoxStack& Builder::boxes_of(const Cell& cell) {
  BoxStack& stack = stacks_.local();
  const size_t n = cell.count();
  stack.size = 0;
  stack.reserve(n);
  std::copy(cell.triangles.begin(), cell.triangles.end(), stack.triangles.begin());
  for (size_t axis = 0; axis < 3; ++axis) {
    BoxStack::Interval& boxes = stack.axes[axis];
    for (Event e : cell.events[axis]) {
      const auto plane = static_cast<int32_t>(plane_of(e));
      if (kind_of(e) != EventKind::end) boxes.lo[triangle_of(e)] = plane;
      if (kind_of(e) != EventKind::start) boxes.hi[triangle_of(e)] = plane;
    }
  }
  stack.size = n;
  return stack;
}

/// Leaves event lists behind: boxes are all that small cells need.
void Builder::build_small(const Cell& cell, uint32_t slot, Subtree& out) {
  build_small_cell(context_, cell.box, cell.depth, cell.bisections, boxes_of(cell), 0, slot, out);
}

/// The split to make; none for a leaf. Counts a bisection.
Split Builder::find_split(Cell& cell) {
  if (cell.depth >= context_.max_depth) return {};
  const Split cheapest = choose_split(cell);
  if (pays(context_, cell.box, cell.count(), cheapest)) return cheapest;
  if (cell.bisections == kMostBisections) return {};
  ++cell.bisections;
  return bisection(context_, cell.box, boxes_of(cell), 0);
}

void Builder::build(Cell cell, uint32_t slot, Subtree& out) {
  if (cancelled_) return;
  if (cell.count() <= kSmallCell) {
    build_small(cell, slot, out);
    report(cell.weight);
    return;
  }
  const Split split = find_split(cell);
  if (!split.found()) {
    out.nodes[slot] = make_leaf(static_cast<uint32_t>(out.references.size()), cell.count());
    out.references.insert(out.references.end(), cell.triangles.begin(), cell.triangles.end());
    report(cell.weight);
    return;
  }

  auto [below, above] = divide(cell, split);
  const bool parallel = cell.count() >= kParallelSubtree;
  cell = {};
  const uint32_t child = out.open_inner(slot, split);
  if (!parallel) {
    if (split.below > 0) build(std::move(below), child, out);
    if (split.above > 0) build(std::move(above), child + 1, out);
    return;
  }
  const auto graft = [&](uint32_t at) -> Subtree& {
    return *out.grafts.emplace_back(at, std::make_unique<Subtree>()).part;
  };
  if (split.empty() != kNoneEmpty) {
    const bool upper = split.below == 0;
    build(std::move(upper ? above : below), 0, graft(child + upper));
    return;
  }
  Subtree& lower = graft(child);
  Subtree& upper = graft(child + 1);
  parallel_tasks([&, &b = below] { build(std::move(b), 0, lower); },
                 [&, &a = above] { build(std::move(a), 0, upper); });
}

void Builder::report(double weight) {
  if (!progress_) return;
  const std::lock_guard lock(progress_mutex_);
  done_ += weight;
  if (done_ - reported_ < 0.005) return;
  reported_ = done_;
  if (!progress_(std::min(done_, 1.0))) cancelled_ = true;
}

}  // namespace

Result<Tree> build_tree(const Lattice& lattice, std::span<const Vec3u> vertices,
                        std::span<const std::array<uint32_t, 3>> triangles, const BuildSettings& settings,
                        const Progress& progress) {
  Context context{vertices,       triangles, lattice.proportions(),
                  settings.costs, 0,         std::min(settings.max_depth, kMaxDepth)};
  context.area_price =
      settings.costs.byte_price * context.half_area_of(lattice.cube()) / static_cast<double>(triangles.size());
  Builder builder(context, progress);
  Subtree parts;
  builder.build(builder.root(lattice), 0, parts);
  if (builder.cancelled()) return Error{ErrorClass::interrupted, "", "interrupted"};
  if (parts.total_nodes() > kMaxChild || parts.total_references() > 0xffffffffu) {
    return Error{ErrorClass::resource, "",
                 "the tree outgrows what a node can address (2^27 nodes, 2^32 references): split the mesh"};
  }
  Subtree whole;
  whole.nodes.reserve(parts.total_nodes());
  whole.references.reserve(parts.total_references());
  parts.flatten_into(whole, 0);
  return Tree{std::move(whole.nodes), std::move(whole.references)};
}

}  // namespace kd::build
