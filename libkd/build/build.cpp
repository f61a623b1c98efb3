#include "build/build.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <utility>

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
  double weight = 1;  // share of the whole build, for progress

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

  Cell root(const Box3u& cube) const;
  void build(Cell cell, uint32_t slot, Subtree& out);
  bool cancelled() const { return cancelled_; }

 private:
  Split choose_split(const Cell& cell) const;
  std::pair<Cell, Cell> divide(const Cell& cell, const Split& split) const;
  void build_small(const Cell& cell, uint32_t slot, Subtree& out) const;
  void report(double weight);

  const Context& context_;
  const Progress& progress_;
  std::mutex progress_mutex_;
  double done_ = 0;      // guarded by progress_mutex_
  double reported_ = 0;  // guarded by progress_mutex_
  std::atomic<bool> cancelled_ = false;
};

Cell Builder::root(const Box3u& cube) const {
  Cell cell;
  cell.box = cube;
  const size_t n = context_.triangles.size();
  cell.triangles.resize(n);
  std::vector<Box3u> boxes(n);
  for (uint32_t i = 0; i < n; ++i) {
    cell.triangles[i] = i;
    boxes[i] = bounds(context_.corners(i));
  }
  for_each_axis(n >= kParallelSweep, [&](int axis) {
    EventList& events = cell.events[static_cast<size_t>(axis)];
    events.reserve(2 * n);
    for (uint32_t i = 0; i < n; ++i) append_events(boxes[i], axis, i, events);
    std::sort(events.begin(), events.end());
  });
  return cell;
}

Split Builder::choose_split(const Cell& cell) const {
  std::array<Split, 3> candidates;
  for_each_axis(cell.count() >= kParallelSweep, [&](int axis) {
    const auto a = static_cast<size_t>(axis);
    candidates[a] = best_split(cell.events[a], axis, cell.box, cell.count(), context_.step, context_.costs);
  });
  return std::min({candidates[0], candidates[1], candidates[2]}, better);
}

/// Which triangles go below the plane, above it, or to both and are clipped.
enum Side : uint8_t { both = 0, below = 1, above = 2 };

std::vector<uint8_t> classify(const EventList& events, uint32_t count, const Split& split) {
  std::vector<uint8_t> side(count, both);
  for (Event e : events) {
    const uint32_t plane = plane_of(e), triangle = triangle_of(e);
    switch (kind_of(e)) {
      case EventKind::end:
        if (plane <= split.plane) side[triangle] = below;
        break;
      case EventKind::start:
        if (plane >= split.plane) side[triangle] = above;
        break;
      case EventKind::flat:
        side[triangle] = plane < split.plane || (plane == split.plane && split.flat_left) ? below : above;
        break;
    }
  }
  return side;
}

/// One child's share of a parent's triangles: their numbers in the child, and boxes of those that were clipped.
struct Share {
  static constexpr uint32_t kAbsent = 0xffffffffu;
  std::vector<uint32_t> number;                     // in the parent -> in the child, or kAbsent
  std::vector<std::pair<uint32_t, Box3u>> clipped;  // number in the child, box in the child's cell
};

EventList child_events(const EventList& parent, int axis, const std::vector<uint8_t>& side, Side wanted,
                       const Share& share) {
  EventList events, fresh;
  events.reserve(parent.size());
  for (Event e : parent) {
    const uint32_t triangle = triangle_of(e);
    if (side[triangle] == wanted) events.push_back(renumbered(e, share.number[triangle]));
  }
  fresh.reserve(2 * share.clipped.size());
  for (const auto& [number, box] : share.clipped) append_events(box, axis, number, fresh);
  merge_events(events, fresh);
  return events;
}

std::pair<Cell, Cell> Builder::divide(const Cell& cell, const Split& split) const {
  const uint32_t n = cell.count();
  const auto axis = static_cast<size_t>(split.axis);
  const std::vector<uint8_t> side = classify(cell.events[axis], n, split);

  std::pair<Cell, Cell> children;
  children.first.box = children.second.box = cell.box;
  children.first.box.hi.set(split.axis, split.plane);
  children.second.box.lo.set(split.axis, split.plane);

  const auto fill = [&](Cell& child, Side wanted) {
    Share share;
    share.number.assign(n, Share::kAbsent);
    for (uint32_t i = 0; i < n; ++i) {
      if (side[i] != wanted && side[i] != both) continue;
      const uint32_t number = child.count();
      if (side[i] == both) {
        const auto box = clipped_bounds(context_.corners(cell.triangles[i]), child.box);
        if (!box) continue;
        share.clipped.emplace_back(number, *box);
      }
      share.number[i] = number;
      child.triangles.push_back(cell.triangles[i]);
    }
    for_each_axis(n >= kParallelSweep, [&](int a) {
      const auto k = static_cast<size_t>(a);
      child.events[k] = child_events(cell.events[k], a, side, wanted, share);
    });
    child.depth = cell.depth + 1;
  };
  if (n >= kParallelSweep) {
    parallel_tasks([&] { fill(children.first, below); }, [&] { fill(children.second, above); });
  } else {
    fill(children.first, below);
    fill(children.second, above);
  }
  const double total = children.first.count() + children.second.count();
  children.first.weight = total > 0 ? cell.weight * children.first.count() / total : 0;
  children.second.weight = cell.weight - children.first.weight;
  return children;
}

/// Leaves event lists behind: the boxes they describe are all that small cells need.
void Builder::build_small(const Cell& cell, uint32_t slot, Subtree& out) const {
  std::vector<BoxedTriangle> stack(cell.count());
  for (uint32_t i = 0; i < cell.count(); ++i) stack[i].triangle = cell.triangles[i];
  for (int axis = 0; axis < 3; ++axis) {
    for (Event e : cell.events[static_cast<size_t>(axis)]) {
      Box3u& box = stack[triangle_of(e)].box;
      if (kind_of(e) != EventKind::end) box.lo.set(axis, plane_of(e));
      if (kind_of(e) != EventKind::start) box.hi.set(axis, plane_of(e));
    }
  }
  build_small_cell(context_, cell.box, cell.depth, stack, 0, slot, out);
}

void Builder::build(Cell cell, uint32_t slot, Subtree& out) {
  if (cancelled_) return;
  if (cell.count() <= kSmallCell) {
    build_small(cell, slot, out);
    report(cell.weight);
    return;
  }
  const Split split = cell.depth < context_.max_depth ? choose_split(cell) : Split{};
  if (split.cost >= context_.leaf_cost(cell.count())) {
    out.nodes[slot] = make_leaf(static_cast<uint32_t>(out.references.size()), cell.count());
    out.references.insert(out.references.end(), cell.triangles.begin(), cell.triangles.end());
    report(cell.weight);
    return;
  }

  std::pair<Cell, Cell> children = divide(cell, split);
  const bool parallel = cell.count() >= kParallelSubtree;
  cell = {};
  const uint32_t pair = out.open_inner(slot, split.axis, split.plane);
  if (parallel) {
    Subtree below_part, above_part;
    parallel_tasks([&] { build(std::move(children.first), 0, below_part); },
                   [&] { build(std::move(children.second), 0, above_part); });
    out.append(below_part, pair);
    out.append(above_part, pair + 1);
  } else {
    build(std::move(children.first), pair, out);
    build(std::move(children.second), pair + 1, out);
  }
}

int depth_limit(const BuildSettings& settings, size_t triangles) {
  const double automatic = 8 + 1.3 * std::log2(std::max<double>(1, static_cast<double>(triangles)));
  return std::min(settings.max_depth > 0 ? settings.max_depth : static_cast<int>(std::lround(automatic)), kMaxDepth);
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
  const Context context{vertices, triangles, lattice.step(), settings.costs, depth_limit(settings, triangles.size())};
  Builder builder(context, progress);
  Subtree whole;
  builder.build(builder.root(lattice.cube()), 0, whole);
  if (builder.cancelled()) return Error{ErrorClass::interrupted, "", "interrupted"};
  if (whole.nodes.size() > kMaxLink || whole.references.size() > 0xffffffffu) {
    return Error{ErrorClass::resource, "",
                 "the tree outgrows what a node can address (2^30 nodes, 2^32 references): split the mesh"};
  }
  return Tree{std::move(whole.nodes), std::move(whole.references)};
}

}  // namespace kd::build
