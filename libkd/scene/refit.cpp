#include <atomic>
#include <cmath>

#include "core/sah.h"
#include "scene/hierarchy.h"
#include "sys/parallel.h"

namespace kd::scene {

namespace {

constexpr uint32_t kNoParent = 0xffffffffu;
constexpr size_t kNodeGrain = 4096;
constexpr size_t kMovedGrain = 128;

/// So many nodes of so large a surface still fit 63 bits.
constexpr double kUnits = 0x1p32, kMaxUnits = 0x1p35;
static_assert(hierarchy_size(kMaxInstances) <= 1u << 27);

}  // namespace

/// Limited to eight times the root's as built: what grew by more has long been found bad.
int64_t Refitter::surface(const HierarchyNode& node) const {
  const double units = half_area(vec_cast<double>(node.hi) - vec_cast<double>(node.lo)) / unit_;
  return static_cast<int64_t>(units < kMaxUnits ? units : kMaxUnits);
}

Refitter::Refitter(std::span<const HierarchyNode> nodes)
    : parents_(nodes.size()), leaves_((nodes.size() + 1) / 2), pending_(nodes.size(), 0) {
  if (nodes.empty()) return;
  parents_[0] = kNoParent;
  const double root = half_area(vec_cast<double>(nodes[0].hi) - vec_cast<double>(nodes[0].lo));
  if (std::isnormal(root / kUnits)) unit_ = root / kUnits;
  std::atomic<int64_t> sum = 0;
  parallel_ranges(nodes.size(), kNodeGrain, [&](size_t begin, size_t end) {
    int64_t own = 0;
    for (size_t i = begin; i < end; ++i) {
      const HierarchyNode& node = nodes[i];
      if (node.is_leaf) {
        leaves_[node.first] = static_cast<uint32_t>(i);
        continue;
      }
      parents_[node.first] = parents_[node.first + 1] = static_cast<uint32_t>(i);
      own += surface(node);
    }
    sum += own;
  });
  surface_ = sum;
  built_surface_ = surface_ > 0 ? surface_ : 1;
}

void Refitter::refit(std::span<HierarchyNode> nodes, std::span<const Instance> instances,
                     std::span<const uint32_t> moved) {
  // Of the paths up from moved leaves, the first to reach a node goes on and the others end there, each counted.
  parallel_ranges(moved.size(), kMovedGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      uint32_t parent = parents_[leaves_[moved[i]]];
      while (parent != kNoParent && std::atomic_ref(pending_[parent]).fetch_add(1, std::memory_order_relaxed) == 0) {
        parent = parents_[parent];
      }
    }
  });
  // Then the last to reach it refits it and goes on: its children are right by then.
  std::atomic<int64_t> sum = 0;
  parallel_ranges(moved.size(), kMovedGrain, [&](size_t begin, size_t end) {
    int64_t added = 0;
    for (size_t i = begin; i < end; ++i) {
      const uint32_t leaf = leaves_[moved[i]];
      const Box3f box = leaf_box(instances[moved[i]].box_scene);
      nodes[leaf].lo = box.lo;
      nodes[leaf].hi = box.hi;
      climb(nodes, leaf, added);
    }
    sum += added;
  });
  surface_ += sum;
}

void Refitter::climb(std::span<HierarchyNode> nodes, uint32_t leaf, int64_t& added) {
  uint32_t parent = parents_[leaf];
  while (parent != kNoParent && std::atomic_ref(pending_[parent]).fetch_sub(1, std::memory_order_acq_rel) == 1) {
    HierarchyNode& node = nodes[parent];
    Box3f box = nodes[node.first].box();
    box.extend(nodes[node.first + 1].box());
    added -= surface(node);
    node.lo = box.lo;
    node.hi = box.hi;
    added += surface(node);
    parent = parents_[parent];
  }
}

}  // namespace kd::scene
