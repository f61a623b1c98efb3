// The settings a sweep goes through: the product of three lists, as a command line gives them.
#pragma once

#include <string>
#include <vector>

#include "build/build.h"
#include "sys/result.h"

namespace kd::bench {

struct SweepLists {
  std::vector<std::string> costs{"1:1.5", "1:1", "1.5:1", "2:1", "3:1", "15:20"};  // traversal:intersection
  std::vector<std::string> bonuses{"0.05", "0.15", "0.3"};
  std::vector<std::string> depths{"auto-4", "auto", "auto+4"};  // or a number
};

struct SweepPoint {
  std::string costs, bonus, depth;  // as given
  build::BuildSettings settings;
};

/// Every combination for a mesh of so many triangles, depths fastest. ErrorClass::usage for an entry that is none.
Result<std::vector<SweepPoint>> sweep_points(const SweepLists& lists, size_t triangles);

}  // namespace kd::bench
