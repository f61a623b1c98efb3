// A scene in motion: its instances and the hierarchy over them, moved from frame to frame.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/culling.h"
#include "scene/expansion.h"
#include "scene/hierarchy.h"
#include "scene/instances.h"
#include "sys/huge_array.h"

namespace kd::scene {

/// Refers to its scene, which must outlive it and stay as it is.
class PlacedScene {
 public:
  /// All instances at a frame; errors as place_instances.
  static Result<PlacedScene> place(const Scene& scene, std::span<const Lattice> lattices, double frame);

  /// The same at the first of `frames`, but without the instances that no ray through `part` of the film can meet at
  /// any of them (culling.h): it must not move to other frames. Errors as place_instances, camera_at and lights_at, at
  /// any of the frames.
  static Result<PlacedScene> place_met(const Scene& scene, std::span<const Lattice> lattices, const FilmPart& part,
                                       std::span<const double> frames);

  double frame() const { return frame_; }
  /// To the bit those of place_instances at the frame; of place_met, those that are there.
  std::span<const Instance> instances() const { return instances_; }
  /// Which of place_instances those are, ascending; empty: all.
  std::span<const uint32_t> numbers() const { return numbers_; }
  /// 1 for those of which the camera sees the fronts alone; empty: for none.
  std::span<const uint8_t> front_only() const { return front_only_; }
  /// How many instances are not there.
  uint32_t left_out() const { return left_out_; }
  /// As build_hierarchy, but where motion has refitted it: then its boxes still hold what is below them, and what a ray
  /// hits is the same.
  std::span<const HierarchyNode> hierarchy() const { return nodes_; }

  /// Moves to another frame, and returns the instances that are not where they were, ascending; valid until the next
  /// move. Costs what moves, not what there is: only instances that keys move are looked at, and only nodes above moved
  /// ones are refitted, unless that has made the hierarchy so bad that it is built again.
  ///
  /// Errors as place_instances. Instances and hierarchy then belong to no frame, until a later move succeeds.
  Result<std::span<const uint32_t>> move_to(double frame);

  /// Whether the last move built the hierarchy again: then any of its nodes may have changed.
  bool rebuilt() const { return rebuilt_; }

 private:
  PlacedScene(Expansion expansion, double frame)
      : expansion_(std::move(expansion)), frame_(frame), instances_(expansion_.count()), refitter_({}) {}
  Result<std::vector<uint8_t>> find_met(std::span<const Lattice> lattices, const FilmPart& part,
                                        std::span<const double> frames);
  std::span<Instance> places() { return {instances_.data(), instances_.size()}; }
  void keep(std::span<const uint8_t> kept);
  void start();
  void build();
  void list_moved();

  Expansion expansion_;
  double frame_;
  HugeArray<Instance> instances_;
  std::vector<uint32_t> numbers_;
  std::vector<uint8_t> front_only_;
  uint32_t left_out_ = 0;
  HugeArray<HierarchyNode> nodes_;
  Refitter refitter_;              // empty if nothing moves
  std::vector<uint8_t> is_moved_;  // of instances, since the last move that succeeded; empty if nothing moves
  std::vector<uint32_t> moved_;
  bool rebuilt_ = false;
};

}  // namespace kd::scene
