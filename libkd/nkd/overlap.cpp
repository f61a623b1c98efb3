#include "nkd/overlap.h"

namespace kd::nkd {

namespace {

// A coordinate has 24 bits, an edge 25, its product with a coordinate 50; a normal's component 51, its product with a
// coordinate 76. Only the test along the normal needs more than 64 bits.
__extension__ using Wide = __int128;

/// Whether the projections on `d` of the triangle and of the box are apart.
template <class Int>
bool separated(const std::array<Vec3<int64_t>, 3>& triangle, const Box3<int64_t>& box, Vec3<Int> d, bool open) {
  Int box_lo = 0, box_hi = 0;
  for (int k = 0; k < 3; ++k) {
    box_lo += d[k] * (d[k] > 0 ? box.lo[k] : box.hi[k]);
    box_hi += d[k] * (d[k] > 0 ? box.hi[k] : box.lo[k]);
  }
  Int triangle_lo = dot(vec_cast<Int>(triangle[0]), d), triangle_hi = triangle_lo;
  for (size_t k = 1; k < 3; ++k) {
    const Int p = dot(vec_cast<Int>(triangle[k]), d);
    triangle_lo = p < triangle_lo ? p : triangle_lo;
    triangle_hi = p > triangle_hi ? p : triangle_hi;
  }
  if (open && box_lo != box_hi) return triangle_hi <= box_lo || triangle_lo >= box_hi;
  return triangle_hi < box_lo || triangle_lo > box_hi;
}

}  // namespace

bool triangle_meets_box(const std::array<Vec3u, 3>& triangle, const Box3u& box, bool open) {
  using Vec3i = Vec3<int64_t>;
  const std::array<Vec3i, 3> t{vec_cast<int64_t>(triangle[0]), vec_cast<int64_t>(triangle[1]),
                               vec_cast<int64_t>(triangle[2])};
  const Box3<int64_t> b{vec_cast<int64_t>(box.lo), vec_cast<int64_t>(box.hi)};
  const std::array<Vec3i, 3> units{Vec3i{1, 0, 0}, Vec3i{0, 1, 0}, Vec3i{0, 0, 1}};
  const std::array<Vec3i, 3> edges{t[1] - t[0], t[2] - t[1], t[0] - t[2]};

  for (const Vec3i& unit : units) {
    if (separated(t, b, unit, open)) return false;
  }
  for (const Vec3i& unit : units) {
    for (const Vec3i& edge : edges) {
      const Vec3i direction = cross(unit, edge);
      if (!(direction == Vec3i{0, 0, 0}) && separated(t, b, direction, open)) return false;
    }
  }
  return !separated(t, b, vec_cast<Wide>(cross(edges[0], edges[1])), open);
}

}  // namespace kd::nkd
