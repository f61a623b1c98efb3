// What a .nkd holds, as plain spans: what a writer is given and what a reader gives.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/lattice.h"
#include "core/material.h"
#include "core/node.h"
#include "core/object_view.h"
#include "core/tree_statistics.h"

namespace kd::nkd {

constexpr uint32_t kFormatVersion = 5;

struct Provenance {
  std::string source_name;   // without folders; of several meshes in it, which
  uint64_t source_hash = 0;  // XXH3-64 of the source file's bytes, or of its and its further files' hashes
  std::string settings;      // as kdbuild flags
  std::string writer;        // program and version
};

/// The sections that traversal reads.
struct Geometry {
  std::span<const Node> nodes;
  std::span<const uint32_t> references;
  std::span<const uint8_t> triangles;  // packed triples of corner_bits() bits: indices to vertices
  std::span<const uint8_t> vertices;   // packed triples of vertex_bits() bits: lattice points; or three float32 each
  int bits = kDefaultLatticeBits;
  VertexForm form = VertexForm::lattice;  // float32 only with kMaxLatticeBits

  int vertex_bits() const { return stored_vertex_bits(form, bits); }
  size_t vertex_count() const { return triple_count(vertices.size(), vertex_bits()); }
  /// As many as (number of vertices - 1) has, at least 1.
  int corner_bits() const { return corner_bits_for(vertex_count()); }
  size_t triangle_count() const { return triple_count(triangles.size(), corner_bits()); }
  /// Of the compact layout.
  size_t vertex_words() const { return vertex_count() * CompactTriangles::words_a_vertex(vertex_bits()); }
  PackedTriangles packed() const { return {{triangles.data(), corner_bits()}, {vertices.data(), vertex_bits()}, form}; }

  static int corner_bits_for(size_t vertex_count) {
    return vertex_count < 2 ? 1 : static_cast<int>(std::bit_width(vertex_count - 1));
  }
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
  bool emissive = false;  // some material has emission; a writer sees for itself
};

inline bool is_emissive(std::span<const Material> materials) {
  return std::any_of(materials.begin(), materials.end(), [](const Material& m) { return !(m.emission == Vec3f{}); });
}

}  // namespace kd::nkd
