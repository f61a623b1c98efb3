// What a stress run found: tables for reading, JSON for programs.
#pragma once

#include "common/report.h"
#include "stress/plan.h"

namespace kd::bench {

struct StressRun {
  stress::StressSettings settings;
  std::string device;
  unsigned threads = 0;  // 0: the device is no CPU
  double seconds = 0;    // making the meshes included
  std::vector<stress::StressRow> rows;
};

stress::Tally total_of(const StressRun& run);

/// Markdown tables of a row a class, a number of bits and a mesh; the closed meshes beside Embree; and what failed.
void print_stress(const StressRun& run);

/// schema/kdbench-stress.schema.json.
tools::Json stress_json(const StressRun& run);

}  // namespace kd::bench
