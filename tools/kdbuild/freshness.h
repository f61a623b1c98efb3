// Where objects came from, as they record it, and whether that still holds: what need not be built again.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kdbuild/compile.h"
#include "kdbuild/job.h"
#include "nkd/contents.h"

namespace kd::tools {

/// Which part of a source an object is.
struct Share {
  size_t mesh = 0;  // from 0
  size_t meshes = 1;
  std::optional<size_t> piece;  // from 0, if the mesh had to be split
};

/// What an object records: a source that is one mesh by its name, else "NAME, mesh 2 of 5" or "NAME, mesh 2 of 5,
/// piece 1", numbers from 1.
nkd::Provenance provenance(const Job& job, uint64_t source_hash, const CompileSettings& settings,
                           const std::optional<Share>& share);

/// What stands where a job's output goes.
struct Freshness {
  std::string stale;                   // why it must be built; empty: it need not be
  std::vector<CompileReport> objects;  // those that are up to date, by what they say of themselves
  std::string scene;                   // that places them; empty if what stands there is one object, or nothing
};

/// Up to date is an object that this program made from a source with this hash by these settings, and a scene whose
/// objects all are, with none of the source's meshes missing. Neither times nor the files themselves are trusted: an
/// unsound object is stale. What else a scene file says is its owner's affair, who may have edited it.
Freshness freshness(const Job& job, uint64_t source_hash, const CompileSettings& settings);

}  // namespace kd::tools
