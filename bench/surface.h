// A rugged terrain of any number of triangles, for measuring at sizes that no mesh at hand has: ridges in many octaves,
// pushed sideways so that it overhangs. Open, in one piece, every edge between at most two triangles.
//
// Coordinates are in model space: x and z about [0, 1], y in [0, 0.35]. They come from integers, +, - and x alone,
// so that every machine makes the same bytes.
#pragma once

#include <cstdint>

#include "core/vec.h"

namespace kd::bench {

/// A square grid of quads, two triangles each, filled row by row until the triangles are used up.
class Surface {
 public:
  explicit Surface(uint64_t triangles);  // 2 to 10^9

  uint64_t triangle_count() const { return triangles_; }
  uint64_t vertex_count() const;
  /// Vertex i; vertices lie in rows.
  Vec3f vertex(uint64_t i) const;
  /// The corners of triangle i.
  struct Corners {
    int32_t a, b, c;
  };
  Corners triangle(uint64_t i) const;

 private:
  uint64_t triangles_;
  uint64_t columns_;  // of quads
  int octaves_;       // the finest has a few quads a cell
};

}  // namespace kd::bench
