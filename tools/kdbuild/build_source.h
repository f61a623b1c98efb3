// One source to its object, or, where it holds more than one mesh or a mesh too large for one object, to several and a
// scene that places them.
#pragma once

#include <string>
#include <vector>

#include "kdbuild/compile.h"
#include "kdbuild/fingerprint.h"
#include "kdbuild/job.h"

namespace kd::tools {

struct SourceReport {
  std::vector<CompileReport> objects;
  std::string scene;                  // the scene file; empty if the source is one object
  size_t parts = 0;                   // of the scene
  std::vector<std::string> files;     // what the source is made of, itself first
  std::vector<std::string> warnings;  // of the source as a whole; a mesh's own are with it
  std::vector<std::string> notes;     // what was done without being asked
  std::vector<Error> failed;          // meshes of several that could not be compiled; the scene leaves them out
};

/// Compiles `job.input`, whose fingerprint is `known`. Whole or not at all: nothing of an earlier run is replaced
/// before everything has been built, and the scene goes first, so that a run killed at that point leaves it with
/// objects that are not up to date.
/// Errors as `read_asset` and `compile`; ErrorClass::usage if no lattice keeps the error that is allowed.
Result<SourceReport> build_source(const Job& job, const Fingerprint& known, const CompileSettings& settings,
                                  Claims& claims, const Progress& progress);

/// The same of a source that is one mesh, to the object of this name. ErrorClass::mesh if it is not.
Result<CompileReport> build_object(const std::string& input, const std::string& object, const CompileSettings& settings,
                                   const Progress& progress = {});

}  // namespace kd::tools
