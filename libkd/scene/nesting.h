// What places what: how many instances characters make, and which objects they reach.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace kd::scene {

/// A part that no scene can have.
struct NestingFault {
  uint32_t character = 0;  // index into Scene::characters
  uint32_t part = 0;       // of the character
  std::string what;
};

/// Counted, not expanded: characters that place one another twice make 2^n instances of n parts.
struct InstanceCounts {
  std::vector<uint32_t> of_character;  // of one placement of each, at most kMaxInstances + 1
  uint32_t shown = 0;                  // of all shown characters together
  std::optional<NestingFault> fault;   // the first one; the counts mean nothing then
};

/// Faults are a character that is placed within itself, nesting deeper than kMaxNesting, a box that places a character,
/// and more instances than kMaxInstances, at the part that is one too many.
InstanceCounts count_instances(const Scene& scene);

struct ObjectUse {
  bool placed = false;         // by some part of what is shown
  bool own_materials = false;  // and somewhere with no other material instead
};

/// One an object.
std::vector<ObjectUse> object_uses(const Scene& scene);

}  // namespace kd::scene
