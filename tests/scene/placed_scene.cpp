// A scene moved from frame to frame is the scene placed at each frame.
#include "scene/placed_scene.h"

#include <cstring>
#include <random>
#include <string>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "scene/parse_scene.h"
#include "sys/parallel.h"

using namespace kd;
using namespace kd::scene;

namespace {

const std::vector<Lattice> kLattices{Lattice{{-0.5, -0.5, -0.5}, {1, 1, 1}, 21}, Lattice{{0, 0, 0}, {2, 1, 3}, 10}};

template <class T>
bool same_bytes(std::span<const T> a, std::span<const T> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

/// Trees of leaves, some of which flutter, on a ground that turns in the second half of the film; others stand still.
Scene forest() {
  std::string leaves, trees;
  for (int i = 0; i < 40; ++i) {
    leaves += fmt::format(R"({}{{"object": "{}", "translate": [{}, {}, {}]{}}})", i ? "," : "", i % 2 ? "a" : "b",
                          i % 5, i / 5, i * 7 % 11,
                          i % 9 ? ""
                                : fmt::format(R"(, "interpolation": "smooth", "keys": [
      {{"frame": {}, "translate": [{}, 0, 1]}}, {{"frame": 40, "translate": [0, {}, 0], "rotate": {{"axis": [0, 1, 0], "degrees": 500}}}}])",
                                              i % 4, i, i));
  }
  for (int i = 0; i < 50; ++i) {
    trees += fmt::format(
        R"({}{{"character": "{}", "translate": [{}, 0, {}]{}}})", i ? "," : "", i % 3 ? "tree" : "stone", i % 7 * 20,
        i / 7 * 20, i % 11 ? "" : R"(, "keys": [{"frame": 5, "scale": [1, 1, 1]}, {"frame": 9, "scale": [2, 2, 2]}])");
  }
  const std::string text = fmt::format(R"({{"camera": {{"position": [0, 0, 5], "target": [0, 0, 0]}},
    "objects": [{{"name": "a", "file": "a"}}, {{"name": "b", "file": "b"}}],
    "characters": [{{"name": "still", "parts": [{{"object": "a"}}, {{"character": "stone"}}]}},
      {{"name": "tree", "shown": false, "parts": [{}]}}, {{"name": "stone", "shown": false, "parts": [{{"object": "b"}}]}},
      {{"name": "grove", "parts": [{}]}},
      {{"name": "ground", "keys": [{{"frame": 50, "rotate": {{"axis": [0, 1, 0], "degrees": 0}}}},
        {{"frame": 100, "rotate": {{"axis": [0, 1, 0], "degrees": 360}}}}], "parts": [{}]}}]}})",
                                       leaves, trees, trees);
  const auto scene = parse_scene(text, "forest");
  REQUIRE_MESSAGE(scene, (scene ? "" : scene.error().line()));
  return *scene;
}

PlacedScene placed(const Scene& scene, double frame) {
  auto out = PlacedScene::place(scene, kLattices, frame);
  REQUIRE_MESSAGE(out, (out ? "" : out.error().line()));
  return std::move(*out);
}

/// Leaves hold their instances and inner nodes their children.
bool is_conservative(const PlacedScene& scene) {
  const auto holds = [](const HierarchyNode& n, const auto& b) {
    return n.lo.x <= b.lo.x && n.lo.y <= b.lo.y && n.lo.z <= b.lo.z && n.hi.x >= b.hi.x && n.hi.y >= b.hi.y &&
           n.hi.z >= b.hi.z;
  };
  const auto nodes = scene.hierarchy();
  for (const HierarchyNode& n : nodes) {
    if (n.is_leaf) {
      if (!holds(n, scene.instances()[n.first].box_scene)) return false;
    } else if (!holds(n, nodes[n.first].box()) || !holds(n, nodes[n.first + 1].box())) {
      return false;
    }
  }
  return true;
}

}  // namespace

TEST_CASE("placed scene: frames reached by motion are those placed alone, to the bit") {
  const Scene scene = forest();
  PlacedScene moving = placed(scene, 1);
  CHECK(same_bytes<HierarchyNode>(moving.hierarchy(), build_hierarchy(moving.instances())));
  for (const double frame : {2.0, 3.0, 3.5, 6.0, 10.0, 40.0, 41.0, 60.0, 75.0, 100.0, -5.0, 99.0}) {
    CAPTURE(frame);
    const std::vector<Instance> before(moving.instances().begin(), moving.instances().end());
    const auto moved = moving.move_to(frame);
    REQUIRE(moved);
    CHECK(moving.frame() == frame);
    const auto alone = place_instances(scene, kLattices, frame);
    REQUIRE(alone);
    CHECK(same_bytes<Instance>(moving.instances(), *alone));
    CHECK(is_conservative(moving));
    // Exactly those that differ, ascending.
    std::vector<uint32_t> expected;
    for (uint32_t i = 0; i < before.size(); ++i) {
      if (std::memcmp(&before[i], &(*alone)[i], sizeof(Instance)) != 0) expected.push_back(i);
    }
    CHECK(std::vector<uint32_t>(moved->begin(), moved->end()) == expected);
    if (frame == 41) CHECK(expected.empty());
    if (moving.rebuilt()) CHECK(same_bytes<HierarchyNode>(moving.hierarchy(), build_hierarchy(*alone)));
  }
}

TEST_CASE("placed scene: the same for any number of threads, rebuilding included") {
  const Scene scene = forest();
  std::vector<HierarchyNode> first;
  std::vector<bool> first_rebuilt;
  for (const unsigned threads : {1u, 2u, 7u}) {
    const ThreadLimit limit(threads);
    PlacedScene moving = placed(scene, 1);
    std::vector<HierarchyNode> nodes;
    std::vector<bool> rebuilt;
    for (double frame = 2; frame < 60; frame += 7) {
      REQUIRE(moving.move_to(frame));
      nodes.insert(nodes.end(), moving.hierarchy().begin(), moving.hierarchy().end());
      rebuilt.push_back(moving.rebuilt());
    }
    if (first.empty()) {
      first = nodes;
      first_rebuilt = rebuilt;
    }
    CHECK(same_bytes<HierarchyNode>(nodes, first));
    CHECK(rebuilt == first_rebuilt);
  }
}

TEST_CASE("placed scene: the hierarchy is built again once everything is elsewhere, and not for a little motion") {
  Scene scene = forest();
  Character cloud;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(-50, 50);
  const auto somewhere = [&] { return Vec3d{unit(random), unit(random), unit(random)}; };
  for (int i = 0; i < 2000; ++i) {
    TransformPlacement t;
    t.keys = {{0, somewhere(), {}, {}}, {100, somewhere(), {}, {}}};
    cloud.parts.emplace_back().placement = t;
  }
  scene.characters = {cloud};
  PlacedScene moving = placed(scene, 0);
  REQUIRE(moving.move_to(0.1));
  CHECK_FALSE(moving.rebuilt());
  REQUIRE(moving.move_to(50));
  CHECK(moving.rebuilt());
  CHECK(same_bytes<HierarchyNode>(moving.hierarchy(), build_hierarchy(moving.instances())));
  REQUIRE(moving.move_to(50.1));
  CHECK_FALSE(moving.rebuilt());
}

TEST_CASE("placed scene: without keys nothing moves") {
  Scene scene = forest();
  scene.characters.resize(1);
  scene.characters[0].parts.resize(1);
  PlacedScene still = placed(scene, 1);
  const auto moved = still.move_to(77);
  REQUIRE(moved);
  CHECK(moved->empty());
  CHECK(still.hierarchy().size() == 1);
  scene.characters.clear();
  PlacedScene none = placed(scene, 1);
  REQUIRE(none.move_to(2));
  CHECK(none.hierarchy().empty());
}

TEST_CASE("placed scene: after a frame that cannot be, a later move makes up for it") {
  Scene scene = forest();
  Part flips;
  TransformPlacement t;
  t.keys = {{1, {}, {}, Vec3d{1, 1, 1}}, {3, {}, {}, Vec3d{-1, 1, 1}}};
  flips.placement = t;
  flips.name = "flips";
  scene.characters[3].parts.push_back(flips);
  PlacedScene moving = placed(scene, 1);
  const auto flat = moving.move_to(2);
  REQUIRE_FALSE(flat);
  CHECK(flat.error().what.find("part 'flips': the placement is singular") != std::string::npos);
  REQUIRE(moving.move_to(3));
  CHECK(same_bytes<Instance>(moving.instances(), *place_instances(scene, kLattices, 3)));
  CHECK(is_conservative(moving));
  REQUIRE_FALSE(moving.move_to(2));
  REQUIRE(moving.move_to(1));
  CHECK(same_bytes<Instance>(moving.instances(), *place_instances(scene, kLattices, 1)));
  CHECK(is_conservative(moving));
}
