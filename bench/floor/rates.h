// What a chip can do at most, measured by kernels that do nothing else.
#pragma once

#include <cstdint>

#include "floor/instructions.h"
#include "sys/result.h"

namespace kd::bench::floors {

/// Instructions a second, each of one thread.
struct InstructionRates {
  double issue = 0;    // FP32 multiply-adds and logic, two to one: no pipe is full, so what is issued at most
  double fma = 0;      // FP32 multiply-adds
  double logic = 0;    // the ALU: three-input logic
  double min_max = 0;  // float minima and maxima; they share the ALU if this is as `logic`
  double fp64 = 0;     // double multiply-adds
  double convert = 0;  // between float and double
};

/// Loads a second, each of one thread, from random places.
struct LoadRates {
  double of_8 = 0;
  double of_16 = 0;
};

struct ChipRates {
  InstructionRates instructions;
  LoadRates l1;         // over kL1Footprint
  LoadRates dram;       // over kDramFootprint
  double streamed = 0;  // bytes a second, read in order over kDramFootprint
};

constexpr uint64_t kL1Footprint = uint64_t{64} << 10;
constexpr uint64_t kDramFootprint = uint64_t{1} << 30;

/// Medians of five. ErrorClass::device and resource; ErrorClass::device in a build without CUDA.
Result<ChipRates> measure_chip(int device_index);
/// The same over any other footprint, of at least 16 bytes and less than 2^35.
Result<LoadRates> measure_loads(int device_index, uint64_t footprint_bytes);

/// How long a cost takes at least, and which pipe it waits for.
struct Bound {
  double seconds = 0;
  const char* pipe = "";
};
Bound bound_of(const Cost& cost, const InstructionRates& rates);

}  // namespace kd::bench::floors
