// What a .nkd holds, as plain spans: what a writer is given and what a reader gives.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/lattice.h"
#include "core/material.h"
#include "core/node.h"
#include "core/tree_statistics.h"

namespace kd::nkd {

constexpr uint32_t kFormatVersion = 2;

struct Provenance {
  std::string source_name;   // without folders
  uint64_t source_hash = 0;  // XXH3-64 of the source file's bytes
  std::string settings;      // as kdbuild flags
  std::string writer;        // program and version
};

/// The sections that traversal reads.
struct Geometry {
  std::span<const Node> nodes;
  std::span<const uint32_t> references;
  std::span<const uint32_t> triangles;  // three indices to vertices each
  std::span<const uint32_t> vertices;   // vertex_words(bits) words each

  size_t triangle_count() const { return triangles.size() / 3; }
};

/// The sections that only shading or reports read. Empty: the object has none.
struct Attributes {
  std::span<const uint32_t> source_primitives;  // per triangle; empty: triangle i is primitive i of the source
  std::span<const Vec3f> normals;               // model space, length 1
  std::span<const uint32_t> normal_indices;     // three a triangle, 0xffffffff: none
  std::span<const Material> materials;
  std::span<const uint16_t> material_ids;  // per triangle
};

struct Summary {
  Lattice lattice;
  double max_displacement = 0;  // model units
  double rms_displacement = 0;
  TreeStatistics tree;
  Provenance provenance;
  std::vector<std::string> material_names;
};

}  // namespace kd::nkd
