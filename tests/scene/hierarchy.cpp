// The hierarchy: built, refitted and built again, always over every instance, for any number of threads.
#include "scene/hierarchy.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include <doctest/doctest.h>

#include "scene/placed_scene.h"
#include "sys/parallel.h"

using namespace kd;
using namespace kd::scene;

namespace {

std::vector<Instance> boxes(size_t count, const auto& box_of) {
  std::vector<Instance> instances(count);
  for (size_t i = 0; i < count; ++i) instances[i].box_scene = box_of(i);
  return instances;
}

std::vector<Instance> random_boxes(size_t count, double size, double far = 0) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  return boxes(count, [&](size_t) {
    const Vec3d lo{far + unit(random) * 100, unit(random) * 30, unit(random) * 100};
    return Box3d{lo, lo + Vec3d{unit(random), unit(random), unit(random)} * size};
  });
}

bool holds(const HierarchyNode& node, const Box3d& box) {
  bool inside = true;
  for (int axis = 0; axis < 3; ++axis)
    inside = inside && node.lo[axis] <= box.lo[axis] && node.hi[axis] >= box.hi[axis];
  return inside;
}

/// What is wrong with a hierarchy over these instances, or nothing.
std::string fault_of(std::span<const HierarchyNode> nodes, std::span<const Instance> instances) {
  if (nodes.size() != hierarchy_size(instances.size())) return "size";
  std::vector<int> seen(instances.size(), 0), depth(nodes.size(), 0);
  for (size_t i = 0; i < nodes.size(); ++i) {
    const HierarchyNode& node = nodes[i];
    if (depth[i] > kMaxHierarchyDepth) return "depth";
    if (node.is_leaf) {
      if (node.first >= instances.size() || seen[node.first]++) return "leaf";
      if (!holds(node, instances[node.first].box_scene)) return "leaf's box";
      continue;
    }
    if (node.first <= i || node.first + 1 >= nodes.size()) return "child";
    for (const uint32_t child : {node.first, node.first + 1}) {
      if (!holds(node, {nodes[child].lo, nodes[child].hi})) return "inner box";
      depth[child] = depth[i] + 1;
    }
  }
  return std::count(seen.begin(), seen.end(), 1) == static_cast<std::ptrdiff_t>(seen.size()) ? "" : "leaves";
}

template <class T>
bool same_bytes(std::span<const T> a, std::span<const T> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

double surface(std::span<const HierarchyNode> nodes) {
  double sum = 0;
  for (const HierarchyNode& n : nodes) {
    const Vec3d e = n.hi - n.lo;
    if (!n.is_leaf) sum += e.x * e.y + e.y * e.z + e.z * e.x;
  }
  return sum;
}

}  // namespace

TEST_CASE("hierarchy: whole and sound for any number of instances, wherever they are") {
  for (const size_t count : {1, 2, 3, 12, 13, 63, 64, 65, 1000, 5000}) {
    CAPTURE(count);
    for (const auto& instances : {random_boxes(count, 1), random_boxes(count, 50), random_boxes(count, 1, 1e6)}) {
      CHECK(fault_of(build_hierarchy(instances), instances) == "");
    }
  }
  CHECK(build_hierarchy(std::vector<Instance>{}).empty());
}

TEST_CASE("hierarchy: boxes that no cut tells apart, and those at the limits of double") {
  const double huge = std::numeric_limits<double>::max() / 4, tiny = std::numeric_limits<double>::denorm_min();
  for (const auto& instances :
       {boxes(3000,
              [](size_t) {
                return Box3d{{0, 0, 0}, {1, 1, 1}};
              }),
        boxes(3000,
              [](size_t) {
                return Box3d{{7, 7, 7}, {7, 7, 7}};
              }),
        boxes(100,
              [&](size_t i) {
                return i % 2 ? Box3d{{-huge, 0, 0}, {0, 1, huge}} : Box3d{{0, 0, 0}, {huge, 1, 1}};
              }),
        boxes(500,
              [&](size_t i) {
                return Box3d{{0, 0, 0}, Vec3d{1, 1, 1} * (static_cast<double>(i) * tiny)};
              }),
        // Ever closer together, as deep as halving can be made to go.
        boxes(3000, [](size_t i) {
          const double x = std::exp2(-static_cast<double>(i) / 3);
          return Box3d{{x, 0, 0}, {x, 0, 0}};
        })}) {
    CHECK(fault_of(build_hierarchy(instances), instances) == "");
  }
}

TEST_CASE("hierarchy: a grid costs at most 2 % more than in halves") {
  // The best tree of a grid halves it, again and again.
  std::vector<Instance> grid = boxes(4096, [](size_t i) {
    const Vec3d lo{static_cast<double>(i % 16), static_cast<double>(i / 16 % 16), static_cast<double>(i / 256)};
    return Box3d{lo, lo + Vec3d{1, 1, 1}};
  });
  std::shuffle(grid.begin(), grid.end(), std::mt19937_64(3));
  double halves = 0;
  Vec3d e{16, 16, 16};
  for (double nodes = 1; nodes < 4096; nodes *= 2) {
    halves += nodes * (e.x * e.y + e.y * e.z + e.z * e.x);
    e.set(e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2, std::max({e.x, e.y, e.z}) / 2);
  }
  CHECK(surface(build_hierarchy(grid)) < 1.02 * halves);
}

TEST_CASE("hierarchy: the same nodes for any number of threads") {
  const std::vector<Instance> instances = random_boxes(300000, 1);
  const std::vector<HierarchyNode> nodes = build_hierarchy(instances);
  CHECK(fault_of(nodes, instances) == "");
  for (const unsigned threads : {1u, 2u, 7u}) {
    const ThreadLimit limit(threads);
    CHECK(same_bytes<HierarchyNode>(build_hierarchy(instances), nodes));
  }
}

TEST_CASE("hierarchy: refitting gives the boxes of a build, and knows what it costs, for any number of threads") {
  std::vector<Instance> instances = random_boxes(20000, 1);
  const std::vector<HierarchyNode> built = build_hierarchy(instances);
  std::vector<uint32_t> moved;
  for (uint32_t i = 0; i < instances.size(); i += 1 + i % 7) {
    moved.push_back(i);
    const Vec3d way = Vec3d{1, -2, 0.5} * static_cast<double>(i % 13);
    instances[i].box_scene = {instances[i].box_scene.lo + way, instances[i].box_scene.hi + way};
  }
  std::vector<HierarchyNode> first;
  double growth = 0;
  for (const unsigned threads : {1u, 2u, 7u}) {
    const ThreadLimit limit(threads);
    std::vector<HierarchyNode> nodes = built;
    Refitter refitter(nodes);
    CHECK(refitter.growth() == 1);
    refitter.refit(nodes, instances, moved);
    if (first.empty()) {
      first = nodes;
      growth = refitter.growth();
    }
    CHECK(same_bytes<HierarchyNode>(nodes, first));
    CHECK(refitter.growth() == growth);
    // Once more, without motion.
    refitter.refit(nodes, instances, moved);
    CHECK(same_bytes<HierarchyNode>(nodes, first));
    CHECK(refitter.growth() == growth);
  }
  CHECK(fault_of(first, instances) == "");
  CHECK(growth == doctest::Approx(surface(first) / surface(built)).epsilon(1e-5));
  // No box is larger than the union of what is below it: all of them are right, not only large enough.
  for (const HierarchyNode& n : first) {
    if (n.is_leaf) {
      CHECK(n.lo == widened(instances[n.first].box_scene).lo);
      continue;
    }
    Box3d both{first[n.first].lo, first[n.first].hi};
    both.extend(Box3d{first[n.first + 1].lo, first[n.first + 1].hi});
    if (!(both == Box3d{n.lo, n.hi})) FAIL("loose box");
  }
}

TEST_CASE("hierarchy: the union of widened boxes is the widened union") {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> exponent(-300, 300);
  for (int i = 0; i < 100000; ++i) {
    const double a = std::pow(10, exponent(random)) * (i % 2 ? 1 : -1);
    const double b = i % 3 ? std::nextafter(a, 1e308) : a * 1.0000001;
    const auto lo = [](double x) { return widened({{x, 0, 0}, {x, 0, 0}}).lo.x; };
    const auto hi = [](double x) { return widened({{x, 0, 0}, {x, 0, 0}}).hi.x; };
    if (std::min(lo(a), lo(b)) != lo(std::min(a, b)) || std::max(hi(a), hi(b)) != hi(std::max(a, b))) FAIL(a);
  }
}
