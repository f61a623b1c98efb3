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

bool holds(const HierarchyNode& node, const auto& box) {
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
      if (!holds(node, nodes[child].box())) return "inner box";
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
    const Vec3d e = vec_cast<double>(n.hi) - vec_cast<double>(n.lo);
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

TEST_CASE("hierarchy: what is large among small things lies above them, and no node is large because of it") {
  std::vector<Instance> instances = random_boxes(4096, 1);
  const double without = surface(build_hierarchy(instances));
  const Box3d ground{{-2000, 0, -2000}, {2000, 0, 2000}}, pavement{{0, 0, 0}, {100, 0.1, 100}};
  instances.insert(instances.begin() + 1000, {boxes(1, [&](size_t) { return pavement; })[0]});
  instances.push_back(boxes(1, [&](size_t) { return ground; })[0]);
  const std::vector<HierarchyNode> nodes = build_hierarchy(instances);
  CHECK(fault_of(nodes, instances) == "");
  const Vec3d extent = vec_cast<double>(nodes[0].hi) - vec_cast<double>(nodes[0].lo);
  const double root = extent.x * extent.y + extent.y * extent.z + extent.z * extent.x;
  CHECK(surface(nodes) < without + 1.01 * root);
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
      CHECK(n.box() == leaf_box(instances[n.first].box_scene));
      continue;
    }
    Box3f both = first[n.first].box();
    both.extend(first[n.first + 1].box());
    if (!(both == n.box())) FAIL("loose box");
  }
}

TEST_CASE("hierarchy: a ray's test of a box leaves out none that it passes, and hardly any other") {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&] { return Vec3d{unit(random), unit(random), unit(random)}; };
  int passed = 0, missed = 0, for_nothing = 0;
  for (int i = 0; i < 400000; ++i) {
    const double scale = std::pow(10, 12 * unit(random)), away = scale * std::pow(10, 3 * std::max(unit(random), 0.0));
    const Vec3d centre = vector() * away, half = vector() * scale;
    Box3d box;
    box.extend(centre - half);
    box.extend(centre + half);
    const Box3f rounded = leaf_box(box);
    const HierarchyNode node{rounded.lo, 0, rounded.hi, 1};
    Ray ray{centre + vector() * (3 * scale), vector(), 0, 1e300};
    if (i % 2 == 0) ray.direction = (centre + half * unit(random) - ray.origin) * (1 / scale);
    if (i % 3 == 0) ray.direction.set(i % 9 / 3, 0.0);
    if (i % 5 == 0) ray.direction.set(i % 15 / 5, unit(random) * std::pow(10, 40 * unit(random) - 41));
    if (i % 7 == 0) ray.origin.set(i % 21 / 7, box.lo[i % 21 / 7]);
    ray.direction = ray.direction * std::pow(10, 6 * unit(random));
    // Where the ray is in the box, by long double. 64 bits are enough: `edge` is what the last of them may move.
    long double enter = 0, leave = ray.t_max, edge = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const long double o = ray.origin[axis], d = ray.direction[axis];
      if (d == 0) {
        if (o < box.lo[axis] || o > box.hi[axis]) leave = -1;
        continue;
      }
      const long double t0 = (box.lo[axis] - o) / d, t1 = (box.hi[axis] - o) / d;
      enter = std::max(enter, std::min(t0, t1));
      leave = std::min(leave, std::max(t0, t1));
      edge = std::max(edge, (std::fabs(o) + std::fabs(static_cast<long double>(centre[axis])) + scale) / std::fabs(d));
    }
    const Passage<float> passage = box_test(ray, node).pass(node, rounded_up(ray.t_max));
    if (enter <= leave) {
      ++passed;
      if (!passage.passes()) FAIL("a box that the ray passes is left out");
      if (passage.enter > enter || passage.leave < leave) FAIL("entered late or left early");
    } else {
      ++missed;
      for_nothing += leave >= 0 && enter - leave > 0x1p-19l * edge && passage.passes();
    }
  }
  CHECK(passed > 50000);
  CHECK(missed > 50000);
  CHECK(for_nothing == 0);
}

TEST_CASE("hierarchy: boxes and rays beyond float32's range are let through") {
  for (const double far : {1e39, 1e100, 1e200}) {
    const Box3f box = leaf_box({{far, -far, -1}, {far * 2, far, 1}});
    const HierarchyNode node{box.lo, 0, box.hi, 1};
    CHECK(box.hi.x == std::numeric_limits<float>::infinity());
    CHECK(box.lo.y == -std::numeric_limits<float>::infinity());
    for (const double from : {0.0, far, -far}) {
      for (const double speed : {1e-200, 1.0, 1e200}) {
        const Ray ray{{from, 0, 0}, {speed, 0, speed * 1e-300}, 0, 1e300};
        CHECK(box_test(ray, node).pass(node, rounded_up(ray.t_max)).passes());
      }
    }
  }
}

TEST_CASE("hierarchy: a leaf's box is as little wider as float32 allows") {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 100000; ++i) {
    const double lo = unit(random) * std::pow(10, 30 * unit(random));
    const double extent = std::fabs(lo) * std::pow(10, 6 * unit(random)), hi = lo + extent;
    const Box3f box = leaf_box({{lo, lo, lo}, {hi, hi, hi}});
    const double least = 0x1p-24 * extent, most = 0x1p-22 * (std::fabs(lo) + std::fabs(hi) + extent);
    if (!(box.lo.x <= lo - least && box.hi.x >= hi + least)) FAIL("too small");
    if (!(box.lo.x >= lo - most && box.hi.x <= hi + most)) FAIL("too large");
  }
}
