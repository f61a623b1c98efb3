// Whether all trees of a mesh answer the same rays alike.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "sys/result.h"

namespace kd::bench {

/// The hits of the primary, shadow and diffuse rays.
using HitCounts = std::array<uint64_t, 3>;

class HitCheck {
 public:
  /// ErrorClass::object, with `mesh` as its place, if the counts are not those of the first tree.
  Result<void> add(const HitCounts& hits, const std::string& mesh);

  /// Of what was added, all alike, in one line.
  std::string verdict() const;

 private:
  std::optional<HitCounts> first_;
  uint64_t trees_ = 0;
};

}  // namespace kd::bench
