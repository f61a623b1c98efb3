// What kdbench floor found, as tables and as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/report.h"
#include "floor/rates.h"
#include "floor/work.h"

namespace kd::bench::floors {

struct ClassResult {
  const char* name = "";
  RayMode mode = RayMode::closest;
  uint64_t rays = 0;
  RayWork work;
  double seconds = 0;  // measured: the median
};

struct ObjectResult {
  std::string object;  // file
  uint64_t triangles = 0;
  uint64_t device_bytes = 0;
  std::vector<ClassResult> classes;
  std::optional<LoadRates> loads;  // over as many bytes as the object has; with ChipRates only
};

/// The least seconds that a class can take by one limit alone.
struct Floors {
  Bound full;         // instructions, every lane of every warp busy
  Bound lockstep;     // instructions, warps as RayWork::warps has them
  double l1 = 0;      // loads, each for itself, all of them in the L1 cache
  double object = 0;  // loads, each for itself, anywhere in the object
  double streamed = 0;
};
Floors floors_of(const ObjectResult& object, const ClassResult& rays, const ChipRates& chip);

/// Active lanes of a warp's 32, of an instruction of the lockstep.
double lanes_of(const ClassResult& rays);

std::string chip_table(const ChipRates& chip);
std::string work_table(const std::vector<ObjectResult>& objects);
std::string floor_table(const std::vector<ObjectResult>& objects, const ChipRates& chip);

/// The report's "chip", if there is one, and "objects".
void add_results(tools::Json& report, const std::vector<ObjectResult>& objects, const std::optional<ChipRates>& chip);

}  // namespace kd::bench::floors
