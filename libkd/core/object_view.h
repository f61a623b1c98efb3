// An object as traversal sees it: plain pointers, on the host or on a device.
#pragma once

#include <cstdint>

#include "core/lattice.h"
#include "core/node.h"
#include "core/triangle.h"
#include "core/triple.h"

namespace kd {

struct ObjectView {
  const Node* nodes = nullptr;
  const uint32_t* references = nullptr;         // leaf order -> triangle
  const TriangleVertices* triangles = nullptr;  // lattice coordinates
  int bits = kDefaultLatticeBits;
};

/// Triangles as an object stores them: packed triples of indices to packed lattice points.
struct PackedTriangles {
  const uint32_t* corners = nullptr;
  const uint32_t* vertices = nullptr;
  int corner_bits = 0;
  int vertex_bits = 0;

  KD_HD KD_INLINE Vec3u corners_of(uint64_t triangle) const {
    return unpack_triple(corners + triangle * static_cast<uint64_t>(triple_words(corner_bits)), corner_bits);
  }
  KD_HD KD_INLINE Vec3u vertex(uint64_t index) const {
    return unpack_triple(vertices + index * static_cast<uint64_t>(triple_words(vertex_bits)), vertex_bits);
  }
  /// The form traversal wants, put where it is wanted: a copy would wait for each of its parts.
  KD_HD KD_INLINE void expand(uint64_t triangle, TriangleVertices& out) const {
    const Vec3u c = corners_of(triangle);
    out.a = vec_cast<float>(vertex(c.x));
    out.b = vec_cast<float>(vertex(c.y));
    out.c = vec_cast<float>(vertex(c.z));
  }
};

}  // namespace kd
