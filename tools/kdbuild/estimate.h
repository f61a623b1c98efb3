// How large an object will be, before its tree is built.
#pragma once

#include <cstdint>

#include "build/build.h"
#include "core/lattice.h"
#include "mesh/mesh.h"
#include "sys/progress.h"
#include "sys/result.h"

namespace kd::tools {

/// What an object takes: so many bytes, and for its tree, which is the larger part, at least and at most so many.
/// `rest` is exact to a few kilobytes, or too large where vertices meet on the lattice.
struct SizeEstimate {
  uint64_t rest = 0;
  uint64_t least_tree = 0;
  uint64_t most_tree = 0;
};

/// Of the object of a clean mesh, with coordinates of `stored_bits` bits (stored_vertex_bits, core/object_view.h). The
/// bounds of the tree hold for any settings, and are far apart.
SizeEstimate estimated_size(const mesh::Mesh& mesh, int stored_bits);

/// About how many bytes the tree of a clean mesh will have on the lattice: trees of samples are built, a
/// few thousand triangles about each of some, for what bytes a triangle takes depends on the mesh and on the settings
/// alike. Rather too many than too few. Errors as build_tree's.
Result<uint64_t> sampled_tree_bytes(const mesh::Mesh& mesh, const Lattice& lattice,
                                    const build::BuildSettings& settings, const Progress& progress);

/// From so many triangles on, samples take a small part of the time that the tree does.
constexpr uint64_t kWorthSampling = 500'000;

}  // namespace kd::tools
