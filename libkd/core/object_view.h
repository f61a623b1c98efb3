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

/// The form in which traversal reads triangles. What it meets is the same in both, to the bit.
enum class TriangleLayout : uint8_t {
  expanded,  // corners: 48 bytes a triangle, loaded at once
  compact,   // indices to shared vertices: 12 bytes a triangle and 8 a vertex, loaded one after the other and unpacked
};

constexpr const char* name_of(TriangleLayout layout) {
  return layout == TriangleLayout::compact ? "compact" : "expanded";
}

/// Calls visit.operator()<layout>().
template <class Visit>
void with_layout(TriangleLayout layout, Visit&& visit) {
  if (layout == TriangleLayout::compact) {
    visit.template operator()<TriangleLayout::compact>();
  } else {
    visit.template operator()<TriangleLayout::expanded>();
  }
}

/// Half of a compact vertex, or all of it.
struct alignas(8) VertexWord {
  uint32_t low, high;
};

/// Triangles in the compact layout. A vertex of up to kNarrowBits bits a coordinate is one word, x in its lowest bits,
/// then y, then z, kNarrowBits each; any other is two, its coordinates as float32 and a zero.
struct CompactTriangles {
  static constexpr int kNarrowBits = 21;

  const uint32_t* corners = nullptr;  // three a triangle
  const VertexWord* vertices = nullptr;
  bool narrow = true;

  /// Of a vertex of `stored_bits` bits a coordinate (stored_vertex_bits).
  static constexpr size_t words_a_vertex(int stored_bits) { return stored_bits <= kNarrowBits ? 1 : 2; }

  KD_HD KD_INLINE static void pack_narrow(Vec3u v, VertexWord* out) {
    out[0] = {v.x | v.y << 21, v.y >> 11 | v.z << 10};
  }
  KD_HD KD_INLINE static void pack_wide(Vec3f v, VertexWord* out) {
    out[0] = {std::bit_cast<uint32_t>(v.x), std::bit_cast<uint32_t>(v.y)};
    out[1] = {std::bit_cast<uint32_t>(v.z), 0};
  }

  KD_HD KD_INLINE Vec3f position(uint64_t index) const {
    if (narrow) {
      const VertexWord w = load(vertices + index);
      constexpr uint32_t kMask = (1u << kNarrowBits) - 1;
      return vec_cast<float>(Vec3u{w.low & kMask, (w.low >> 21 | w.high << 11) & kMask, w.high >> 10});
    }
    const VertexWord xy = load(vertices + 2 * index), z = load(vertices + 2 * index + 1);
    return {float_from_bits(xy.low), float_from_bits(xy.high), float_from_bits(z.low)};
  }
  KD_HD KD_INLINE TriangleVertices operator[](uint64_t triangle) const {
    const uint32_t* c = corners + 3 * triangle;
    const uint32_t a = c[0], b = c[1], d = c[2];
    TriangleVertices out;
    out.a = position(a);
    out.b = position(b);
    out.c = position(d);
    return out;
  }
};

struct ObjectView {
  const Node* nodes = nullptr;
  const uint32_t* references = nullptr;         // leaf order -> triangle
  const TriangleVertices* triangles = nullptr;  // lattice space; null in the compact layout
  int bits = kDefaultLatticeBits;
  CompactTriangles compact;  // in the compact layout

  ObjectView() = default;
  ObjectView(const Node* nodes_, const uint32_t* references_, const TriangleVertices* triangles_, int bits_,
             const CompactTriangles& compact_ = {})
      : nodes(nodes_), references(references_), triangles(triangles_), bits(bits_), compact(compact_) {}

  template <TriangleLayout layout>
  KD_HD KD_INLINE TriangleVertices triangle(uint64_t index) const {
    if constexpr (layout == TriangleLayout::compact) return compact[index];
    return load(triangles + index);
  }
  /// Where the layout is not known when compiling.
  KD_HD KD_INLINE TriangleVertices triangle(uint64_t index) const {
    return triangles ? triangle<TriangleLayout::expanded>(index) : triangle<TriangleLayout::compact>(index);
  }
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
  /// The same for the compact layout: a triangle's corners, and a vertex.
  KD_HD KD_INLINE void unpack_corners(uint64_t triangle, uint32_t* out) const {
    const Vec3u c = corners[triangle];
    out[3 * triangle] = c.x;
    out[3 * triangle + 1] = c.y;
    out[3 * triangle + 2] = c.z;
  }
  KD_HD KD_INLINE bool narrow() const { return CompactTriangles::words_a_vertex(vertices.bits) == 1; }
  KD_HD KD_INLINE void compact_vertex(uint64_t index, VertexWord* out) const {
    if (narrow()) {
      CompactTriangles::pack_narrow(vertices[index], out + index);
    } else {
      CompactTriangles::pack_wide(position(index), out + 2 * index);
    }
  }
};

}  // namespace kd
