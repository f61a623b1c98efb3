#include "floor/rates.h"

namespace kd::bench::floors {

namespace {

const Error kAbsent{ErrorClass::device, "",
                    "this build has no CUDA backend (configured with KD_CUDA=OFF, or without nvcc)"};

}  // namespace

Result<ChipRates> measure_chip(int) { return kAbsent; }
Result<LoadRates> measure_loads(int, uint64_t) { return kAbsent; }

}  // namespace kd::bench::floors
