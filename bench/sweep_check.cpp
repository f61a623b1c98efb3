#include "sweep_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace kd::bench {

Result<void> HitCheck::add(const HitCounts& hits, const std::string& mesh) {
  ++trees_;
  if (!first_) first_ = hits;
  if (hits == *first_) return {};
  return Error{
      ErrorClass::object, mesh,
      fmt::format("tree {} answers {} primary, shadow and bounce rays with a hit, the first one {}: one of the "
                  "two is wrong",
                  trees_, fmt::join(hits, " / "), fmt::join(*first_, " / "))};
}

std::string HitCheck::verdict() const {
  return fmt::format("All {} trees answer alike: {} primary, shadow and bounce rays hit.", trees_,
                     fmt::join(first_.value_or(HitCounts{}), " / "));
}

}  // namespace kd::bench
