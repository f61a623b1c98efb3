// An object as traversal sees it: plain pointers, on the host or on a device.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/lattice.h"
#include "core/node.h"
#include "core/triangle.h"
#include "core/triple.h"

namespace kd {

/// How an object stores its vertices. `float32`: lattice coordinates rounded to float32, not to the lattice, which then
/// has kMaxLatticeBits; for benchmarks, as nothing that is exact on the lattice is exact for them. The tree is built
/// over the lattice points nearest to what is stored.
enum class VertexForm : uint8_t { lattice, float32 };

constexpr const char* name_of(VertexForm form) { return form == VertexForm::float32 ? "float32" : "lattice"; }

struct ObjectView {
  const Node* nodes = nullptr;
  const uint32_t* references = nullptr;         // leaf order -> triangle
  const TriangleVertices* triangles = nullptr;  // lattice space
  int bits = kDefaultLatticeBits;
};

/// Bits of each number in a vertex as it is stored: a lattice coordinate, or the bits of a float.
constexpr int stored_vertex_bits(VertexForm form, int lattice_bits) {
  return form == VertexForm::float32 ? 32 : lattice_bits;
}

/// Triangles as an object stores them: triples of indices to vertices, and the vertices.
struct PackedTriangles {
  PackedTriples corners;
  PackedTriples vertices;
  VertexForm form = VertexForm::lattice;

  /// Lattice space.
  KD_HD KD_INLINE Vec3f position(uint64_t index) const {
    const Vec3u v = vertices[index];
    if (form == VertexForm::float32) return {float_from_bits(v.x), float_from_bits(v.y), float_from_bits(v.z)};
    return vec_cast<float>(v);
  }
  /// The lattice point that the tree was built over: the vertex, or the one nearest to it.
  KD_HD KD_INLINE Vec3u lattice_point(uint64_t index) const {
    const Vec3f p = position(index);
    return vec_cast<uint32_t>(Vec3f{std::rint(p.x), std::rint(p.y), std::rint(p.z)});
  }
  /// The form traversal wants, put where it is wanted: a copy would wait for each of its parts.
  KD_HD KD_INLINE void expand(uint64_t triangle, TriangleVertices& out) const {
    const Vec3u c = corners[triangle];
    out.a = position(c.x);
    out.b = position(c.y);
    out.c = position(c.z);
  }
};

}  // namespace kd
