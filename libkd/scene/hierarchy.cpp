#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/sah.h"
#include "scene/instances.h"

namespace kd::scene {

namespace {

constexpr int kSahDepth = 32;  // from here on halves, so that no input outgrows kMaxHierarchyDepth

class HierarchyBuilder {
 public:
  explicit HierarchyBuilder(std::span<const Instance> instances) : instances_(instances), order_(instances.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
  }

  std::vector<HierarchyNode> take() {
    nodes_.emplace_back();
    build(0, 0, order_.size(), 0);
    return std::move(nodes_);
  }

 private:
  const Box3d& box(size_t position) const { return instances_[order_[position]].box_scene; }
  Vec3d centre(uint32_t instance) const {
    const Box3d& b = instances_[instance].box_scene;
    return (b.lo + b.hi) * 0.5;
  }
  void sort_along(int axis, size_t begin, size_t end) {
    std::sort(order_.begin() + static_cast<std::ptrdiff_t>(begin), order_.begin() + static_cast<std::ptrdiff_t>(end),
              [&](uint32_t a, uint32_t b) {
                const double ca = centre(a)[axis], cb = centre(b)[axis];
                return ca != cb ? ca < cb : a < b;
              });
  }
  void build(size_t slot, size_t begin, size_t end, int depth);
  size_t best_middle(size_t begin, size_t end);

  std::span<const Instance> instances_;
  std::vector<uint32_t> order_;
  std::vector<HierarchyNode> nodes_;
  std::vector<double> right_area_;
};

Box3d widened(const Box3d& box) {
  const auto margin = [](double c) { return 1e-12 * std::fabs(c) + std::numeric_limits<double>::min(); };
  const Vec3d lo = box.lo, hi = box.hi;
  return {{lo.x - margin(lo.x), lo.y - margin(lo.y), lo.z - margin(lo.z)},
          {hi.x + margin(hi.x), hi.y + margin(hi.y), hi.z + margin(hi.z)}};
}

/// Leaves [begin, end) sorted along the best axis and returns where to cut.
size_t HierarchyBuilder::best_middle(size_t begin, size_t end) {
  double best_cost = std::numeric_limits<double>::infinity();
  int best_axis = 0;
  size_t best = begin + (end - begin) / 2;
  right_area_.resize(end - begin);
  for (int axis = 0; axis < 3; ++axis) {
    sort_along(axis, begin, end);
    Box3d right;
    for (size_t i = end; i-- > begin + 1;) {
      right.extend(box(i));
      right_area_[i - begin] = half_area(right.extent());
    }
    Box3d left;
    for (size_t i = begin + 1; i < end; ++i) {
      left.extend(box(i - 1));
      const double cost = half_area(left.extent()) * static_cast<double>(i - begin) +
                          right_area_[i - begin] * static_cast<double>(end - i);
      if (cost < best_cost) {
        best_cost = cost;
        best_axis = axis;
        best = i;
      }
    }
  }
  if (best_axis != 2) sort_along(best_axis, begin, end);
  return best;
}

void HierarchyBuilder::build(size_t slot, size_t begin, size_t end, int depth) {
  Box3d bounds;
  for (size_t i = begin; i < end; ++i) bounds.extend(box(i));
  bounds = widened(bounds);
  if (end - begin == 1) {
    nodes_[slot] = {bounds.lo, bounds.hi, order_[begin], 1};
    return;
  }
  const size_t middle = depth < kSahDepth ? best_middle(begin, end) : begin + (end - begin) / 2;
  const size_t child = nodes_.size();
  nodes_[slot] = {bounds.lo, bounds.hi, static_cast<uint32_t>(child), 0};
  nodes_.resize(child + 2);
  build(child, begin, middle, depth + 1);
  build(child + 1, middle, end, depth + 1);
}

}  // namespace

std::vector<HierarchyNode> build_hierarchy(std::span<const Instance> instances) {
  if (instances.empty()) return {};
  return HierarchyBuilder(instances).take();
}

}  // namespace kd::scene
