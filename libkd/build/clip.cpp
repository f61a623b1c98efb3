#include "build/clip.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kd::build {

namespace {

/// More than a computed coordinate is off by: values up to 2^24 through at most six cuts, 2^-26.
constexpr double kRounding = 0x1p-20;

/// A corner of a polygon, and for each coordinate how far off it may be: 0 or kRounding. A coordinate is exact, and
/// then a whole number, if it is a vertex's or a cell plane's, or lies between two that are equal; otherwise it was
/// computed. So a wall keeps its plane and a triangle that only touches a cell with a vertex is not blown up, while a
/// sliver thinner than double can tell is not lost.
struct Corner {
  std::array<double, 3> at;
  std::array<double, 3> slack;
};

struct Polygon {
  std::array<Corner, 28> corners;  // six cuts make 9 of 3, and 28 if rounding conspired at each
  size_t count = 0;

  void push(const Corner& c) { corners[count++] = c; }
};

/// Where an edge meets the plane, or the plane moved outward if the edge has a computed end. `dp`, `dq`: how far p and
/// q lie beyond the plane on the `sign` side; `moved`: how far outward.
Corner cut(const Corner& p, const Corner& q, size_t axis, double plane, double sign, double dp, double dq,
           double moved) {
  Corner c;
  const double t = (moved - dp) / (dq - dp);
  for (size_t k = 0; k < 3; ++k) {
    const double along = q.at[k] - p.at[k];
    c.at[k] = p.at[k] + t * along;
    c.slack[k] = along == 0 ? std::max(p.slack[k], q.slack[k]) : kRounding;
  }
  c.at[axis] = plane + sign * moved;
  c.slack[axis] = moved;
  return c;
}

/// Calls keep(corner) for the corners of what of `in` has sign * coordinate <= sign * plane, or a little more: where an
/// edge has a computed end, it is cut at the plane moved outward by kRounding.
template <class Keep>
inline void clip(const Polygon& in, size_t axis, double plane, double sign, const Keep& keep) {
  const Corner* p = &in.corners[0];
  double dp = sign * (p->at[axis] - plane);
  for (size_t i = 0; i < in.count; ++i) {
    const Corner* q = &in.corners[i + 1 < in.count ? i + 1 : 0];
    const double dq = sign * (q->at[axis] - plane);
    const bool p_inside = dp <= p->slack[axis], q_inside = dq <= q->slack[axis];
    if (p_inside) keep(*p);
    if (p_inside != q_inside) {
      const double moved = std::max(p->slack[axis], q->slack[axis]);
      if (dp != moved && dq != moved) keep(cut(*p, *q, axis, plane, sign, dp, dq, moved));
    }
    p = q;
    dp = dq;
  }
}

/// The box of corners, slack and all, in whole steps and inside a cell.
class CornerBox {
 public:
  void extend(const Corner& c) {
    for (size_t k = 0; k < 3; ++k) {
      lo_[k] = std::min(lo_[k], c.at[k] - c.slack[k]);
      hi_[k] = std::max(hi_[k], c.at[k] + c.slack[k]);
    }
  }
  Box3u within(const Box3u& cell) const {
    if (lo_[0] > hi_[0]) return {};
    const auto one = [&](size_t k, uint32_t& lo, uint32_t& hi) {
      const int axis = static_cast<int>(k);
      const double cell_lo = cell.lo[axis], cell_hi = cell.hi[axis];
      lo = static_cast<uint32_t>(static_cast<int64_t>(std::min(std::max(std::floor(lo_[k]), cell_lo), cell_hi)));
      hi = static_cast<uint32_t>(static_cast<int64_t>(std::min(std::max(std::ceil(hi_[k]), cell_lo), cell_hi)));
    };
    Box3u box;
    one(0, box.lo.x, box.hi.x);
    one(1, box.lo.y, box.hi.y);
    one(2, box.lo.z, box.hi.z);
    return box;
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::array<double, 3> lo_{kInfinity, kInfinity, kInfinity};
  std::array<double, 3> hi_{-kInfinity, -kInfinity, -kInfinity};
};

}  // namespace

SplitBounds split_bounds(const LatticeTriangle& triangle, const Box3u& cell, int axis, uint32_t plane) {
  const Box3u whole = bounds(triangle);
  Polygon buffers[2];
  Polygon* polygon = &buffers[0];
  Polygon* next = &buffers[1];
  for (Vec3u p : triangle) polygon->push({{double(p.x), double(p.y), double(p.z)}, {0, 0, 0}});
  const auto clip_to = [&](size_t k, double at, double sign) {
    next->count = 0;
    clip(*polygon, k, at, sign, [&](const Corner& c) { next->push(c); });
    std::swap(polygon, next);
  };
  for (size_t k = 0; k < 3; ++k) {
    const int a = static_cast<int>(k);
    if (whole.lo[a] < cell.lo[a]) clip_to(k, cell.lo[a], -1);
    if (whole.hi[a] > cell.hi[a]) clip_to(k, cell.hi[a], 1);
  }

  CornerBox below, above;
  const auto k = static_cast<size_t>(axis);
  clip(*polygon, k, plane, 1, [&](const Corner& c) { below.extend(c); });
  clip(*polygon, k, plane, -1, [&](const Corner& c) { above.extend(c); });
  Box3u lower = cell, upper = cell;
  lower.hi.set(axis, plane);
  upper.lo.set(axis, plane);
  return {below.within(lower), above.within(upper)};
}

}  // namespace kd::build
