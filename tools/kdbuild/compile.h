// One mesh in memory to one object: clean, normalise, build, write.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/tree_statistics.h"
#include "kdbuild/settings.h"
#include "mesh/clean.h"
#include "mesh/topology.h"
#include "nkd/contents.h"
#include "sys/atomic_file.h"
#include "sys/progress.h"
#include "sys/result.h"

namespace kd::tools {

/// What was done to one mesh, and what came of it.
struct CompileReport {
  std::string mesh_name;  // empty: the source's only one
  std::string output;
  bool up_to_date = false;  // nothing was done: what the object says of itself, and no more
  uint64_t source_triangles = 0;
  uint64_t triangles = 0;  // in the object
  uint64_t vertices = 0;
  mesh::CleanReport clean;
  mesh::Topology topology;
  Lattice lattice;
  VertexForm vertex_form = VertexForm::lattice;
  std::optional<double> max_error;  // what chose the lattice's bits, if anything did
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

/// Drops what is no surface, and counts it. `where` names the mesh in errors: ErrorClass::mesh if nothing is left.
Result<void> clean_mesh(mesh::Mesh& mesh, const std::string& where, CompileReport& report);

/// Where an object lies, and what it records of its making.
struct ObjectTarget {
  std::string where;  // names the mesh in errors
  std::string output;
  Lattice lattice;                            // its box contains the mesh
  VertexForm vertices = VertexForm::lattice;  // float32 only with kMaxLatticeBits
  nkd::Provenance provenance;
};

/// Compiles a clean mesh to an object that is whole but does not bear its name yet. Errors as those of the steps;
/// ErrorClass::mesh too if no triangle is left on the lattice.
Result<AtomicFile> compile(const mesh::Mesh& mesh, const ObjectTarget& target, const build::BuildSettings& settings,
                           CompileReport& report, const Progress& progress);

}  // namespace kd::tools
