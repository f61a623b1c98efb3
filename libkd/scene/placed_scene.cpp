#include "scene/placed_scene.h"

#include <algorithm>
#include <new>

namespace kd::scene {

namespace {

/// The hierarchy is built again once refitting has made its nodes' surface so many times what it was. At 1.5 random
/// rays pass a third more nodes than in a fresh one, at 2 two thirds, at 5 four times as many (200,000 instances
/// adrift).
constexpr double kMaxGrowth = 1.5;

Error out_of_memory(const Scene& scene) {
  return {ErrorClass::resource, scene.path, "not enough memory for the scene's instances"};
}

}  // namespace

Result<PlacedScene> PlacedScene::place(const Scene& scene, std::span<const Lattice> lattices, double frame) {
  try {
    auto expansion = Expansion::of(scene, lattices);
    if (!expansion) return expansion.error();
    PlacedScene placed(std::move(*expansion), frame);
    const auto done = placed.expansion_.place_all(frame, placed.places());
    if (!done) return done.error();
    placed.start();
    return placed;
  } catch (const std::bad_alloc&) {
    return out_of_memory(scene);
  }
}

Result<PlacedScene> PlacedScene::place_met(const Scene& scene, std::span<const Lattice> lattices, const FilmPart& part,
                                           std::span<const double> frames) {
  try {
    auto expansion = Expansion::of(scene, lattices);
    if (!expansion) return expansion.error();
    PlacedScene placed(std::move(*expansion), frames.front());
    // If nothing moves, all frames are alike.
    const auto met = placed.find_met(lattices, part, key_range(scene) ? frames : frames.first(1));
    if (!met) return met.error();
    placed.keep(*met);
    placed.start();
    return placed;
  } catch (const std::bad_alloc&) {
    return out_of_memory(scene);
  }
}

/// Which instances are met at some of the frames. Places all, and leaves them as they are at the first frame.
Result<std::vector<uint8_t>> PlacedScene::find_met(std::span<const Lattice> lattices, const FilmPart& part,
                                                   std::span<const double> frames) {
  const Scene& scene = expansion_.scene();
  std::vector<uint8_t> met(instances_.size(), 0), moved(instances_.size(), 0);
  if (const auto done = expansion_.place_all(frames.back(), places()); !done) return done.error();
  for (size_t i = frames.size(); i-- > 0;) {
    if (const auto done = expansion_.place_moving(frames[i], places(), moved); !done) return done.error();
    const auto camera = camera_at(scene, frames[i]);
    if (!camera) return camera.error();
    auto lights = lights_at(scene, frames[i]);
    if (!lights) return lights.error();
    mark_met({*camera, scene.film, part, std::move(*lights)}, lattices, instances_, met);
  }
  return met;
}

void PlacedScene::keep(std::span<const uint8_t> kept) {
  const auto count = static_cast<size_t>(std::count(kept.begin(), kept.end(), 1));
  left_out_ = static_cast<uint32_t>(kept.size() - count);
  if (left_out_ == 0) return;
  HugeArray<Instance> instances(count);
  numbers_.reserve(count);
  for (uint32_t i = 0; i < kept.size(); ++i) {
    if (!kept[i]) continue;
    instances[numbers_.size()] = instances_[i];
    numbers_.push_back(i);
  }
  instances_ = std::move(instances);
  expansion_.keep(kept);
}

/// The hierarchy, and room for what will move.
void PlacedScene::start() {
  nodes_ = HugeArray<HierarchyNode>(hierarchy_size(instances_.size()));
  build();
  front_only_ = expansion_.front_only();
  if (expansion_.moving().empty()) return;
  is_moved_.assign(instances_.size(), 0);
  size_t movable = 0;
  for (const Expansion::Range& range : expansion_.moving()) movable += range.count;
  moved_.reserve(movable);
}

void PlacedScene::build() {
  const std::span<HierarchyNode> nodes(nodes_.data(), nodes_.size());
  build_hierarchy(instances_, nodes);
  if (!expansion_.moving().empty()) refitter_ = Refitter(nodes);
}

Result<std::span<const uint32_t>> PlacedScene::move_to(double frame) {
  try {
    rebuilt_ = false;
    frame_ = frame;
    const auto done = expansion_.place_moving(frame, places(), is_moved_);
    if (!done) return done.error();
    list_moved();
    refitter_.refit({nodes_.data(), nodes_.size()}, instances_, moved_);
    if (refitter_.growth() > kMaxGrowth) {
      build();
      rebuilt_ = true;
    }
    return std::span<const uint32_t>(moved_);
  } catch (const std::bad_alloc&) {
    return out_of_memory(expansion_.scene());
  }
}

void PlacedScene::list_moved() {
  moved_.clear();
  for (const Expansion::Range& range : expansion_.moving()) {
    for (uint32_t i = range.first; i < range.first + range.count; ++i) {
      if (!is_moved_[i]) continue;
      moved_.push_back(i);
      is_moved_[i] = 0;
    }
  }
}

}  // namespace kd::scene
