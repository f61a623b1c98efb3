// What it takes to compile one mesh and to have the object ready to trace: seconds, bytes, and the tree's figures. Ours
// and Embree's builds alternate, so that whatever else the machine does falls on all alike.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/tree_statistics.h"
#include "kdbuild/settings.h"
#include "peak_memory.h"

namespace kd::bench {

struct BuildEffort {
  unsigned threads = 2;  // of the builds that are not on one thread, and of the process that measures memory
  int repeats = 5;       // >= 1
};

/// Bytes of a .nkd.
struct ObjectBytes {
  uint64_t total = 0;
  uint64_t nodes = 0;
  uint64_t references = 0;
  uint64_t triangles = 0;
  uint64_t vertices = 0;

  uint64_t rest() const { return total - nodes - references - triangles - vertices; }  // header, attributes
};

/// Seconds are one a repeat, and of loads five.
struct BuildMeasurement {
  std::string mesh;  // the path, as given
  uint64_t triangles = 0;
  TreeStatistics tree;
  uint64_t references = 0;
  std::vector<double> one_thread;     // mesh on its lattice -> tree
  std::vector<double> more_threads;   // the same on BuildEffort::threads
  std::vector<double> embree_medium;  // Embree's BVH over the same triangles, one thread; empty without Embree
  std::vector<double> embree_high;
  PeakMemory memory;
  ObjectBytes bytes;
  std::vector<double> open;    // mapping and validating, one thread, in the page cache
  std::vector<double> expand;  // the triangles, as the CPU backend wants them, one thread
};

/// `object_path` is where compile_in_child left the object, and `memory` what it returned.
/// Errors as those of reading, building and opening.
Result<BuildMeasurement> measure_build(const std::string& mesh_path, const std::string& object_path,
                                       const PeakMemory& memory, const tools::CompileSettings& settings,
                                       const BuildEffort& effort);

}  // namespace kd::bench
