// Binned building after Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007: boxes are sorted
// into bins by their centres, and the cuts between bins are compared. By their sizes, too: by centres alone the ground
// under a city would end among the houses at its middle, and all nodes on the way there would be as large as the
// ground. The nodes do not depend on the number of threads: where a subtree's nodes lie follows from how many leaves
// are before it.
#include "scene/hierarchy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/sah.h"
#include "sys/parallel.h"

namespace kd::scene {

namespace {

constexpr int kMaxBins = 32;
constexpr size_t kMaxExhaustive = 12;         // so few leaves are sorted, and every cut is compared
constexpr int kSahDepth = 32;                 // from here on halves, so that no input outgrows kMaxHierarchyDepth
constexpr size_t kParallelHalves = 2048;      // leaves from which on two threads may build the halves
constexpr size_t kParallelBinning = 1 << 17;  // and several fill the bins
constexpr size_t kBinGrain = 1 << 14;
static_assert(kSahDepth + 27 <= kMaxHierarchyDepth, "2^26 instances halve in 26 levels");

/// A box as how far it reaches along -x, -y, -z, x, y and z: it grows by one maximum of all six. Empty at first.
struct Reach {
  static constexpr double kNowhere = std::numeric_limits<double>::lowest();
  std::array<double, 6> way{kNowhere, kNowhere, kNowhere, kNowhere, kNowhere, kNowhere};

  Reach() = default;
  explicit Reach(const Box3d& box) : way{-box.lo.x, -box.lo.y, -box.lo.z, box.hi.x, box.hi.y, box.hi.z} {}

  void extend(const Reach& other) {
    for (size_t i = 0; i < 6; ++i) way[i] = way[i] < other.way[i] ? other.way[i] : way[i];
  }
  double half_area() const { return kd::half_area({way[3] + way[0], way[4] + way[1], way[5] + way[2]}); }
  double centre(int axis) const {
    const auto i = static_cast<size_t>(axis);
    return way[i + 3] * 0.5 - way[i] * 0.5;
  }
};

constexpr int kSize = 3;  // what boxes are told apart by: their centres along three axes, and their sizes
constexpr int kKeys = 4;

struct Entry {
  Reach reach;
  uint32_t instance = 0;
  float size = 0;  // logarithm of the box's surface

  Entry() = default;
  Entry(const Box3d& box, uint32_t instance_) : reach(box), instance(instance_) {
    const double area = reach.half_area();  // 0 of a point, and no number of what double cannot hold
    constexpr double kLeast = std::numeric_limits<double>::min(), kMost = std::numeric_limits<double>::max();
    size = static_cast<float>(std::log2(area <= kMost ? max_of(area, kLeast) : kMost));
  }
  double key(int which) const { return which == kSize ? static_cast<double>(size) : reach.centre(which); }
};

/// The least and the largest of each key.
struct KeyRange {
  std::array<double, kKeys> lo, hi;

  KeyRange() {
    lo.fill(std::numeric_limits<double>::max());
    hi.fill(std::numeric_limits<double>::lowest());
  }
  /// How many of the keys tell entries apart: sizes that differ by less than a factor of two do not.
  int count() const { return hi[kSize] - lo[kSize] < 1 ? kSize : kKeys; }

  void extend(const Entry& entry) {
    for (int which = 0; which < kKeys; ++which) {
      const auto i = static_cast<size_t>(which);
      const double key = entry.key(which);
      lo[i] = min_of(lo[i], key);
      hi[i] = max_of(hi[i], key);
    }
  }
};

/// Leaves [begin, end), under a node that is to be made.
struct Task {
  size_t begin, end;
  KeyRange keys;   // of the leaves
  uint32_t slot;   // the node
  uint32_t below;  // the first of the 2 (end - begin) - 2 nodes below it
  int depth;

  size_t count() const { return end - begin; }
  /// More would be empty.
  int bins() const { return count() < 64 ? 8 : count() < 512 ? 16 : kMaxBins; }
};

struct Bin {
  Reach reach;
  size_t count = 0;

  void add(const Bin& other) {
    reach.extend(other.reach);
    count += other.count;
  }
};

/// Which bin an entry falls into by each of its keys. A key that does not differ has one.
class Binning {
 public:
  Binning(const KeyRange& keys, int bins) : last_(bins - 1) {
    for (size_t i = 0; i < kKeys; ++i) {
      const double range = keys.hi[i] - keys.lo[i], scale = bins / range;
      if (!std::isfinite(range) || !std::isfinite(scale)) continue;
      lo_[i] = keys.lo[i];
      scale_[i] = scale;
    }
  }
  int bin(const Entry& entry, int which) const {
    const auto i = static_cast<size_t>(which);
    return std::min(static_cast<int>((entry.key(which) - lo_[i]) * scale_[i]), last_);
  }

 private:
  std::array<double, kKeys> lo_{}, scale_{};
  int last_;
};

/// A cut between leaves; in front of leaf `position` for sorted ones, behind bin `position` for binned ones.
struct Cut {
  double cost = std::numeric_limits<double>::infinity();
  int key = 0;
  size_t position = 0;

  bool exists() const { return cost < std::numeric_limits<double>::infinity(); }
  void improve(const Cut& other) {
    if (other.cost < cost) *this = other;
  }
};

/// Rows of bins, one a key.
struct Bins {
  explicit Bins(const Task& task)
      : keys(static_cast<size_t>(task.keys.count())), count(static_cast<size_t>(task.bins())) {
    for (auto& row : rows) std::fill_n(row.begin(), count, Bin{});
  }
  size_t keys;
  size_t count;  // of each
  std::array<std::array<Bin, kMaxBins>, kKeys> rows;
};

Cut best_cut(const Bins& bins) {
  Cut best;
  for (size_t key = 0; key < bins.keys; ++key) {
    const auto& row = bins.rows[key];
    std::array<double, kMaxBins> right_cost;  // of the bins from i on
    Bin right;
    for (size_t i = bins.count; i-- > 1;) {
      right.add(row[i]);
      right_cost[i] = right.reach.half_area() * static_cast<double>(right.count);
    }
    const size_t all = right.count + row[0].count;
    Bin left;
    for (size_t i = 0; i + 1 < bins.count; ++i) {
      if (row[i].count == 0) continue;  // the cut before it is the same
      left.add(row[i]);
      if (left.count == all) break;
      best.improve(
          {left.reach.half_area() * static_cast<double>(left.count) + right_cost[i + 1], static_cast<int>(key), i});
    }
  }
  return best;
}

class HierarchyBuilder {
 public:
  HierarchyBuilder(std::span<const Instance> instances, std::span<HierarchyNode> nodes)
      : instances_(instances), entries_(instances.size()), nodes_(nodes) {
    parallel_ranges(instances.size(), kBinGrain, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) entries_[i] = {instances[i].box_scene, static_cast<uint32_t>(i)};
    });
  }

  void build_all() {
    Task root{0, entries_.size(), {}, 0, 1, 0};
    for (size_t i = 0; i < entries_.size(); ++i) root.keys.extend(entries_[i]);
    build(root);
  }

 private:
  void build(const Task& task);
  size_t divide(const Task& task, KeyRange& left, KeyRange& right);
  size_t divide_sorted(const Task& task, KeyRange& left, KeyRange& right);
  size_t halve(const Task& task, KeyRange& left, KeyRange& right);
  void fill(const Task& task, const Binning& binning, Bins& bins) const;
  template <class IsLeft>
  size_t partition(const Task& task, KeyRange& left, KeyRange& right, const IsLeft& is_left);

  std::span<const Instance> instances_;
  HugeArray<Entry> entries_;
  std::span<HierarchyNode> nodes_;
};

void HierarchyBuilder::build(const Task& task) {
  HierarchyNode& node = nodes_[task.slot];
  if (task.count() == 1) {
    const uint32_t instance = entries_[task.begin].instance;
    const Box3f box = leaf_box(instances_[instance].box_scene);
    node = {box.lo, instance, box.hi, 1};
    return;
  }
  KeyRange left_keys, right_keys;
  size_t middle = task.begin;
  if (task.depth < kSahDepth) {
    middle = task.count() <= kMaxExhaustive ? divide_sorted(task, left_keys, right_keys)
                                            : divide(task, left_keys, right_keys);
  }
  if (middle == task.begin) middle = halve(task, left_keys, right_keys);
  const uint32_t child = task.below;
  const Task left{task.begin, middle, left_keys, child, child + 2, task.depth + 1};
  const auto left_below = static_cast<uint32_t>(hierarchy_size(left.count()) - 1);
  const Task right{middle, task.end, right_keys, child + 1, child + 2 + left_below, task.depth + 1};
  if (task.count() >= kParallelHalves) {
    parallel_tasks([&] { build(left); }, [&] { build(right); });
  } else {
    build(left);
    build(right);
  }
  Box3f box = nodes_[child].box();
  box.extend(nodes_[child + 1].box());
  node = {box.lo, child, box.hi, 0};
}

/// Reorders the task's leaves so that those of the left half come first, and returns where the right ones begin. The
/// beginning, if no cut tells the leaves apart.
size_t HierarchyBuilder::divide(const Task& task, KeyRange& left, KeyRange& right) {
  const Binning binning(task.keys, task.bins());
  Bins bins(task);
  fill(task, binning, bins);
  const Cut cut = best_cut(bins);
  if (!cut.exists()) return task.begin;
  return partition(task, left, right,
                   [&](const Entry& e) { return binning.bin(e, cut.key) <= static_cast<int>(cut.position); });
}

void HierarchyBuilder::fill(const Task& task, const Binning& binning, Bins& bins) const {
  const auto fill_range = [&](size_t begin, size_t end, Bins& out) {
    for (size_t i = begin; i < end; ++i) {
      for (size_t key = 0; key < out.keys; ++key) {
        Bin& bin = out.rows[key][static_cast<size_t>(binning.bin(entries_[i], static_cast<int>(key)))];
        bin.reach.extend(entries_[i].reach);
        ++bin.count;
      }
    }
  };
  if (task.count() < kParallelBinning) return fill_range(task.begin, task.end, bins);
  PerThread<Bins> parts{Bins(task)};
  parallel_ranges(task.count(), kBinGrain,
                  [&](size_t begin, size_t end) { fill_range(task.begin + begin, task.begin + end, parts.local()); });
  for (const Bins& part : parts) {
    for (size_t key = 0; key < bins.keys; ++key) {
      for (size_t i = 0; i < bins.count; ++i) bins.rows[key][i].add(part.rows[key][i]);
    }
  }
}

template <class IsLeft>
size_t HierarchyBuilder::partition(const Task& task, KeyRange& left, KeyRange& right, const IsLeft& is_left) {
  size_t i = task.begin, j = task.end;
  while (i < j) {
    if (is_left(entries_[i])) {
      left.extend(entries_[i++]);
    } else {
      right.extend(entries_[i]);
      std::swap(entries_[i], entries_[--j]);
    }
  }
  return i;
}

/// `divide` for few leaves: every cut by every key.
size_t HierarchyBuilder::divide_sorted(const Task& task, KeyRange& left, KeyRange& right) {
  const size_t count = task.count();
  std::array<std::array<uint8_t, kMaxExhaustive>, kKeys> orders;
  std::array<Entry, kMaxExhaustive> entries;
  std::copy_n(entries_.data() + task.begin, count, entries.begin());
  Cut best;
  for (int which = 0; which < task.keys.count(); ++which) {
    auto& order = orders[static_cast<size_t>(which)];
    std::array<double, kMaxExhaustive> keys;
    for (size_t i = 0; i < count; ++i) {  // by insertion
      const double key = entries[i].key(which);
      size_t at = i;
      for (; at > 0 && key < keys[at - 1]; --at) {
        keys[at] = keys[at - 1];
        order[at] = order[at - 1];
      }
      keys[at] = key;
      order[at] = static_cast<uint8_t>(i);
    }
    std::array<double, kMaxExhaustive> right_cost;
    Reach reach;
    for (size_t i = count; i-- > 1;) {
      reach.extend(entries[order[i]].reach);
      right_cost[i] = reach.half_area() * static_cast<double>(count - i);
    }
    reach = {};
    for (size_t i = 1; i < count; ++i) {
      reach.extend(entries[order[i - 1]].reach);
      best.improve({reach.half_area() * static_cast<double>(i) + right_cost[i], which, i});
    }
  }
  if (!best.exists()) return task.begin;
  for (size_t i = 0; i < count; ++i) {
    const Entry& entry = entries[orders[static_cast<size_t>(best.key)][i]];
    entries_[task.begin + i] = entry;
    (i < best.position ? left : right).extend(entry);
  }
  return task.begin + best.position;
}

size_t HierarchyBuilder::halve(const Task& task, KeyRange& left, KeyRange& right) {
  const size_t middle = task.begin + task.count() / 2;
  for (size_t i = task.begin; i < task.end; ++i) (i < middle ? left : right).extend(entries_[i]);
  return middle;
}

}  // namespace

Box3f leaf_box(const Box3d& box_scene) {
  constexpr float kMax = std::numeric_limits<float>::max(), kInfinity = std::numeric_limits<float>::infinity();
  const auto up = [](double x) { return x > kMax ? kInfinity : x < -kMax ? -kMax : rounded_up(x); };
  Box3f box;
  for (int axis = 0; axis < 3; ++axis) {
    const double lo = box_scene.lo[axis], hi = box_scene.hi[axis], wider = 0x1p-23 * (hi - lo);
    box.lo.set(axis, -up(-(lo - wider - 1e-12 * std::fabs(lo))));
    box.hi.set(axis, up(hi + wider + 1e-12 * std::fabs(hi)));
  }
  return box;
}

void build_hierarchy(std::span<const Instance> instances, std::span<HierarchyNode> nodes) {
  if (!instances.empty()) HierarchyBuilder(instances, nodes).build_all();
}

std::vector<HierarchyNode> build_hierarchy(std::span<const Instance> instances) {
  std::vector<HierarchyNode> nodes(hierarchy_size(instances.size()));
  build_hierarchy(instances, nodes);
  return nodes;
}

}  // namespace kd::scene
