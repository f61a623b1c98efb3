// The settings a sweep goes through: the product of four lists, as a command line gives them.
#pragma once

#include <string>
#include <vector>

#include "build/build.h"
#include "sys/result.h"

namespace kd::bench {

struct SweepLists {
  std::vector<std::string> costs{"1:1.5", "1:1", "1.5:1", "2:1", "3:1", "15:20"};  // traversal:intersection
  std::vector<std::string> bonuses{"0.08", "0.2"};
  std::vector<std::string> prices{"0", "0.02", "0.1", "0.25", "0.35", "0.5"};  // of a byte a triangle
  std::vector<std::string> depths{"64"};                                       // inner nodes
};

struct SweepPoint {
  std::string costs, bonus, price, depth;  // as given
  build::BuildSettings settings;
};

/// Every combination, depths fastest. ErrorClass::usage for an entry that is none.
Result<std::vector<SweepPoint>> sweep_points(const SweepLists& lists);

}  // namespace kd::bench
