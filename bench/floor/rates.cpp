#include "floor/rates.h"

namespace kd::bench::floors {

Bound bound_of(const Cost& cost, const InstructionRates& rates) {
  const Bound bounds[] = {{cost.issued / rates.issue, "issue"},
                          {cost.alu / rates.logic, "ALU"},
                          {cost.fp64 / rates.fp64, "FP64"},
                          {cost.convert / rates.convert, "conversions"}};
  Bound longest;
  for (const Bound& bound : bounds) {
    if (bound.seconds > longest.seconds) longest = bound;
  }
  return longest;
}

}  // namespace kd::bench::floors
