// What the shapes are put together from.
#pragma once

#include <cmath>

#include "stress/shapes.h"

namespace kd::stress {

inline uint32_t add(Shape& shape, Vec3u v) {
  shape.vertices.push_back(v);
  return static_cast<uint32_t>(shape.vertices.size() - 1);
}

/// Triangles without area are left out: no ray can meet them.
inline void add_triangle(Shape& shape, Vec3u a, Vec3u b, Vec3u c) {
  const auto ab = vec_cast<int64_t>(b) - vec_cast<int64_t>(a), ac = vec_cast<int64_t>(c) - vec_cast<int64_t>(a);
  if (cross(ab, ac) == Vec3<int64_t>{0, 0, 0}) return;
  const uint32_t i = add(shape, a), j = add(shape, b), k = add(shape, c);
  shape.triangles.push_back({i, j, k});
}

inline uint32_t rounded(double v, uint32_t top) {
  return static_cast<uint32_t>(std::fmin(std::fmax(std::nearbyint(v), 0.0), top));
}

// Closed ones (closed_shapes.cpp).
Shape ball(int bits);
Shape small_ball(int bits);
Shape box(int bits);
Shape tetrahedron(int bits);
Shape fan(int bits);
Shape small_fan(int bits);

// Others (open_shapes.cpp).
Shape needles(int bits);
Shape slivers(int bits);
Shape mixed(int bits);
Shape duplicates(int bits);
Shape flat_cells(int bits);
Shape flat_mesh(int bits);
Shape stairs(int bits);
Shape sheets(int bits);

}  // namespace kd::stress
