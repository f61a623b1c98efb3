// What shapes an object, apart from its source.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "build/build.h"
#include "core/object_view.h"
#include "mesh/asset.h"

namespace kd::tools {

constexpr uint64_t kLargestObject = (1ull << 31) - 1;  // bytes: what the offsets of a FlatBuffer reach
constexpr uint64_t kSmallestObjectLimit = 1ull << 16;  // bytes: a header and a few hundred triangles fit

struct CompileSettings {
  int bits = kDefaultLatticeBits;
  std::optional<double> max_error;            // model units: then the fewest bits that keep it, instead of `bits`
  VertexForm vertices = VertexForm::lattice;  // float32 only with kMaxLatticeBits bits, and without max_error
  bool ambient_from_diffuse = false;
  mesh::Split split = mesh::Split::none;
  uint64_t max_object_size = kLargestObject;  // bytes: a mesh that needs more becomes several objects
  build::BuildSettings tree;
};

/// The settings as flags, without those that only repeat a default: what a .nkd records of how it was made.
std::string settings_text(const CompileSettings& settings);

}  // namespace kd::tools
