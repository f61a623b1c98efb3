// A scene's instances by number: which of them a character's parts make, and where each is.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/instances.h"

namespace kd::scene {

/// Refers to the scene, which must outlive it and stay as it is.
class Expansion {
 public:
  /// ErrorClass::scene, with the part's line, for a NestingFault.
  static Result<Expansion> of(const Scene& scene, std::span<const Lattice> lattices);

  uint32_t count() const { return count_; }

  /// Writes all instances at a frame; `out` has count() of them. Errors as place_instances.
  Result<void> place_all(double frame, std::span<Instance> out) const;

 private:
  friend class Placer;

  /// Of one placement of a character; one element a part.
  struct CharacterPlan {
    std::vector<uint32_t> first;     // instance, from 0
    std::vector<uint32_t> material;  // index into override_materials, or kOwnMaterials
    uint32_t count = 0;
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

  explicit Expansion(const Scene& scene) : scene_(&scene) {}

  const Scene* scene_;
  std::vector<CharacterPlan> plans_;  // one a character
  std::vector<ObjectFrames> objects_;
  std::vector<Root> roots_;  // the shown characters
  uint32_t count_ = 0;
};

}  // namespace kd::scene
