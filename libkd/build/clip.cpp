#include "build/clip.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kd::build {

namespace {

/// More than a computed coordinate is off by: values up to 2^24 through at most six cuts, 2^-26.
constexpr double kRounding = 0x1p-20;

/// A corner of a polygon. A coordinate is exact, and then a whole number, if it is a vertex's or a cell plane's, or
/// lies between two that are equal; otherwise it was computed. So a wall keeps its plane and a triangle that only
/// touches a cell with a vertex is not blown up, while a sliver thinner than double can tell is not lost.
struct Corner {
  std::array<double, 3> at;
  std::array<bool, 3> exact;

  double slack(size_t axis) const { return exact[axis] ? 0 : kRounding; }
};

struct Polygon {
  std::array<Corner, 28> corners;  // six cuts make 9 of 3, and 28 if rounding conspired at each
  size_t count = 0;

  void push(const Corner& c) { corners[count++] = c; }
};

/// What of `in` has sign * coordinate <= sign * plane, or a little more: where an edge has a computed end, it is cut at
/// the plane moved outward by kRounding.
void clip(const Polygon& in, size_t axis, double plane, double sign, Polygon& out) {
  out.count = 0;
  for (size_t i = 0; i < in.count; ++i) {
    const Corner& p = in.corners[i];
    const Corner& q = in.corners[i + 1 < in.count ? i + 1 : 0];
    const double dp = sign * (p.at[axis] - plane), dq = sign * (q.at[axis] - plane);
    const bool p_inside = dp <= p.slack(axis), q_inside = dq <= q.slack(axis);
    if (p_inside) out.push(p);
    const double moved = std::max(p.slack(axis), q.slack(axis));
    if (p_inside == q_inside || dp == moved || dq == moved) continue;
    Corner cut;
    const double t = (moved - dp) / (dq - dp);
    for (size_t k = 0; k < 3; ++k) {
      cut.at[k] = p.at[k] + t * (q.at[k] - p.at[k]);
      cut.exact[k] = p.exact[k] && q.exact[k] && p.at[k] == q.at[k];
    }
    cut.at[axis] = plane + sign * moved;
    cut.exact[axis] = moved == 0;
    out.push(cut);
  }
}

}  // namespace

std::optional<Box3u> clipped_bounds(const LatticeTriangle& triangle, const Box3u& cell) {
  const Box3u whole = bounds(triangle);
  Polygon a, b;
  for (Vec3u p : triangle) a.push({{double(p.x), double(p.y), double(p.z)}, {true, true, true}});
  for (size_t axis = 0; axis < 3; ++axis) {
    const int k = static_cast<int>(axis);
    if (whole.lo[k] < cell.lo[k]) {
      clip(a, axis, cell.lo[k], -1, b);
      std::swap(a, b);
    }
    if (whole.hi[k] > cell.hi[k]) {
      clip(a, axis, cell.hi[k], 1, b);
      std::swap(a, b);
    }
  }
  if (a.count == 0) return std::nullopt;

  Box3u box;
  for (size_t axis = 0; axis < 3; ++axis) {
    double lo = std::numeric_limits<double>::infinity(), hi = -lo;
    for (size_t i = 0; i < a.count; ++i) {
      const double slack = a.corners[i].slack(axis);
      lo = std::min(lo, a.corners[i].at[axis] - slack);
      hi = std::max(hi, a.corners[i].at[axis] + slack);
    }
    const int k = static_cast<int>(axis);
    const double cell_lo = cell.lo[k], cell_hi = cell.hi[k];
    box.lo.set(k, static_cast<uint32_t>(std::clamp(std::floor(lo), cell_lo, cell_hi)));
    box.hi.set(k, static_cast<uint32_t>(std::clamp(std::ceil(hi), cell_lo, cell_hi)));
  }
  return box;
}

}  // namespace kd::build
