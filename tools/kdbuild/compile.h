// One mesh to one object: read, clean, normalise, build, write.
#pragma once

#include <string>
#include <vector>

#include "build/build.h"
#include "core/tree_statistics.h"
#include "mesh/clean.h"
#include "mesh/topology.h"
#include "sys/progress.h"
#include "sys/result.h"

namespace kd::tools {

struct CompileSettings {
  int bits = kDefaultLatticeBits;
  bool ambient_from_diffuse = false;
  build::BuildSettings tree;
};

/// The settings as flags: what a .nkd records of how it was made.
std::string settings_text(const CompileSettings& settings);

struct CompileReport {
  uint64_t source_triangles = 0;
  uint64_t triangles = 0;  // in the object
  uint64_t vertices = 0;
  mesh::CleanReport clean;
  mesh::Topology topology;
  Lattice lattice;
  uint64_t welded_vertices = 0;
  mesh::FaceFault collapsed;
  double max_displacement = 0;  // model units
  double rms_displacement = 0;
  TreeStatistics tree;
  uint64_t references = 0;
  uint64_t bytes = 0;
  struct {
    double read = 0, clean = 0, normalise = 0, build = 0, write = 0;
  } seconds;
  std::vector<std::string> warnings;
};

/// Errors as those of the steps; ErrorClass::mesh too if cleaning leaves nothing.
Result<CompileReport> compile(const std::string& input, const std::string& output, const CompileSettings& settings,
                              const Progress& progress);

}  // namespace kd::tools
