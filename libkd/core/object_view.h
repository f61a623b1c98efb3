// An object as traversal sees it: plain pointers, on the host or on a device.
#pragma once

#include <cstdint>

#include "core/node.h"
#include "core/triangle.h"

namespace kd {

struct ObjectView {
  const Node* nodes = nullptr;
  const uint32_t* references = nullptr;         // leaf order -> triangle
  const TriangleVertices* triangles = nullptr;  // lattice coordinates
  int bits = kDefaultLatticeBits;
};

/// The form traversal wants of a triangle that is stored as three indices to packed vertices.
KD_HD KD_INLINE TriangleVertices expand_triangle(const uint32_t* vertex_data, const uint32_t* corners, int bits) {
  const int words = vertex_words(bits);
  TriangleVertices t;
  t.a = vec_cast<float>(unpack_vertex(vertex_data + static_cast<uint64_t>(corners[0]) * words, bits));
  t.b = vec_cast<float>(unpack_vertex(vertex_data + static_cast<uint64_t>(corners[1]) * words, bits));
  t.c = vec_cast<float>(unpack_vertex(vertex_data + static_cast<uint64_t>(corners[2]) * words, bits));
  return t;
}

}  // namespace kd
