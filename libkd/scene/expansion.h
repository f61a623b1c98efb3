// A scene's instances by number: which of them a character's parts make, and where each is.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/instances.h"

namespace kd::scene {

/// Refers to the scene, which must outlive it and stay as it is.
class Expansion {
 public:
  /// ErrorClass::scene, with the part's line, for a NestingFault.
  static Result<Expansion> of(const Scene& scene, std::span<const Lattice> lattices);

  const Scene& scene() const { return *scene_; }
  uint32_t count() const { return count_; }

  struct Range {
    uint32_t first = 0;
    uint32_t count = 0;
  };
  /// Keeps those instances of which `kept` is not 0, under numbers from 0 in the same order, and forgets the others.
  /// `kept` has count() elements.
  void keep(std::span<const uint8_t> kept);

  /// 1 for instances of which the camera sees the fronts alone; empty: for none.
  std::vector<uint8_t> front_only() const;

  /// The instances that keys move, ascending and apart.
  std::span<const Range> moving() const { return moving_; }

  /// Writes all instances at a frame; `out` has count() of them. Errors as place_instances.
  Result<void> place_all(double frame, std::span<Instance> out) const;

  /// The same, but only of the moving ones, those that are not where they were; and sets `moved` of each to 1.
  Result<void> place_moving(double frame, std::span<Instance> out, std::span<uint8_t> moved) const;

 private:
  friend class Placer;

  /// Of one placement of a character; one element a part.
  struct CharacterPlan {
    std::vector<uint32_t> first;     // instance, from 0
    std::vector<uint32_t> material;  // index into override_materials, or kOwnMaterials
    std::vector<uint32_t> moving;    // parts that have keys, or place a character that moves
    uint32_t count = 0;
    bool has_keys = false;  // the character itself
    bool searched = false;  // for what moves

    bool moves() const { return has_keys || !moving.empty(); }
  };
  /// Lattice space to model space and to the unit cube.
  struct ObjectFrames {
    Frame model;
    Frame unit_cube;
    Lattice lattice;
  };
  struct Root {
    uint32_t character = 0;
    uint32_t first = 0;  // instance
  };

  static constexpr uint32_t kForgotten = 0xffffffffu;

  explicit Expansion(const Scene& scene) : scene_(&scene), plans_(scene.characters.size()) {}
  void find_moving(uint32_t character);
  void list_moving(uint32_t character, uint32_t first);
  void list_moving(Range range);
  void mark_sides(uint32_t character, uint32_t first, std::optional<Sides> outer, std::span<uint8_t> marks) const;

  const Scene* scene_;
  std::vector<CharacterPlan> plans_;  // one a character
  std::vector<ObjectFrames> objects_;
  std::vector<Root> roots_;         // the shown characters
  std::vector<Root> moving_roots_;  // those of them that move
  std::vector<Range> moving_;
  std::vector<uint32_t> slots_;  // the numbers that instances have now, or kForgotten; empty: all are as they were
  uint32_t count_ = 0;
};

}  // namespace kd::scene
