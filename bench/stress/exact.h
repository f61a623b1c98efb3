// The oracle: where a snapped ray crosses triangles, in integers. It shares nothing with core/triangle.h but the
// statement of the contract: a snapped ray is the exact line; where it meets an edge or a vertex, it counts as moved by
// (e, e^2), e infinitesimal and positive, along the two axes across its own.
//
// Units: one unit of length is a grid step, 2^(B-24) lattice steps; a direction's is 2^-24. Then
//   coordinates relative to the ray's origin   |r| <= 2^24
//   sheared coordinates  r 2^24 - d along      |x| <= 2^49
//   edge functions  px qy - py qx              |u| <= 2^99
//   their sum (all of one sign)                |u + v + w| < 2^101
//   the depth's numerator, at most the sum times the farthest vertex, 2^24:  < 2^125
// so that 64 and 128 bits hold everything.
#pragma once

#include "core/lattice_ray.h"
#include "stress/case_view.h"

namespace kd::stress {

__extension__ using Wide = __int128;

/// A snapped ray in integers; axes exchanged so that `along` is the ray's, as in core/triangle.h.
struct ExactRay {
  int first = 2, second = 1, along = 0;  // axes
  int shift = 0;                         // lattice steps -> units: << shift
  int64_t o_first = 0, o_second = 0, o_along = 0;
  int64_t d_first = 0, d_second = 0;
  int64_t sign = 1;  // of the direction along
};

/// False if the ray is not on the grids that it is promised to be on, or too far outside the cube.
KD_HD inline bool to_integers(const LatticeRay& ray, int bits, ExactRay& out) {
  out.along = ray.axis;
  out.first = ray.axis == 0 ? 2 : 0;
  out.second = ray.axis == 1 ? 2 : 1;
  out.shift = kMaxLatticeBits - bits;
  bool whole = true;
  const auto integer = [&](float value, double units, double most) {
    const double v = static_cast<double>(value) * units;  // exact: units is a power of two
    if (!(std::fabs(v) <= most)) {
      whole = false;
      return int64_t{0};
    }
    const auto i = static_cast<int64_t>(v);
    whole = whole && static_cast<double>(i) == v;
    return i;
  };
  const double units = static_cast<double>(1u << out.shift), most = 0x1p24;
  out.o_first = integer(ray.origin[out.first], units, most);
  out.o_second = integer(ray.origin[out.second], units, most);
  out.o_along = integer(ray.origin[out.along], units, most);
  out.d_first = integer(ray.direction[out.first], 0x1p24, 0x1p24);
  out.d_second = integer(ray.direction[out.second], 0x1p24, 0x1p24);
  out.sign = ray.direction[out.along] > 0 ? 1 : -1;
  return whole && std::fabs(ray.direction[out.along]) == 1;
}

/// A point sheared along the ray into the plane across its axis, and its distance along the ray.
struct ShearedPoint {
  int64_t x, y, s;
};

KD_HD KD_INLINE ShearedPoint sheared(const ExactRay& ray, Vec3u p) {
  const auto unit = [&](int axis) { return static_cast<int64_t>(p[axis]) << ray.shift; };
  const int64_t s = (unit(ray.along) - ray.o_along) * ray.sign;
  return {(unit(ray.first) - ray.o_first) * (1 << 24) - ray.d_first * s,
          (unit(ray.second) - ray.o_second) * (1 << 24) - ray.d_second * s, s};
}

/// Where the line crosses a triangle.
struct Crossing {
  bool met = false;
  bool touches = false;  // an edge or a vertex: the rule decided
  double s = 0;          // lattice steps along the ray, to 4 roundings
  double v = 0, w = 0;   // weights of the second and third vertex, to 4 roundings
  double farthest = 0;   // of the vertices, along the ray, lattice steps
  bool behind = false;   // exactly: s < 0
};

namespace detail {

/// p x q for the ray moved by (e, e^2), which takes (e, e^2) off p and q: p x q + e (p.y - q.y) + e^2 (q.x - p.x).
KD_HD KD_INLINE int side(Wide product, const ShearedPoint& p, const ShearedPoint& q) {
  if (product != 0) return product > 0 ? 1 : -1;
  if (p.y != q.y) return p.y > q.y ? 1 : -1;
  return p.x == q.x ? 0 : q.x > p.x ? 1 : -1;
}

KD_HD KD_INLINE Wide edge(const ShearedPoint& p, const ShearedPoint& q) {
  return static_cast<Wide>(p.x) * q.y - static_cast<Wide>(p.y) * q.x;
}

KD_HD KD_INLINE double magnitude(int64_t a) { return static_cast<double>(a < 0 ? -a : a); }

}  // namespace detail

KD_HD inline Crossing cross_triangle(const ExactRay& ray, const OracleTriangle& t) {
  using namespace detail;
  Crossing out;
  const ShearedPoint a = sheared(ray, t.a), b = sheared(ray, t.b), c = sheared(ray, t.c);
  // All on one side of the ray: a coordinate that is 0 is negative once the ray has moved.
  if ((a.x > 0 && b.x > 0 && c.x > 0) || (a.x <= 0 && b.x <= 0 && c.x <= 0)) return out;
  if ((a.y > 0 && b.y > 0 && c.y > 0) || (a.y <= 0 && b.y <= 0 && c.y <= 0)) return out;
  const Wide bc = edge(b, c), ca = edge(c, a), ab = edge(a, b);
  const int turn = side(bc, b, c);
  out.met = turn != 0 && side(ca, c, a) == turn && side(ab, a, b) == turn;
  if (!out.met) return out;
  out.touches = bc == 0 || ca == 0 || ab == 0;
  const Wide sum = bc + ca + ab;
  const Wide depth = bc * a.s + ca * b.s + ab * c.s;
  const double whole = static_cast<double>(sum), step = 1.0 / static_cast<double>(1u << ray.shift);
  out.s = static_cast<double>(depth) / whole * step;
  out.v = static_cast<double>(ca) / whole;
  out.w = static_cast<double>(ab) / whole;
  out.farthest = max_of(magnitude(a.s), magnitude(b.s), magnitude(c.s)) * step;
  out.behind = (depth < 0) != (sum < 0) && depth != 0;
  return out;
}

/// Whether the half-line s >= 0 may touch the box: its shadow in the plane across the ray contains the ray.
KD_HD KD_INLINE bool touches(const ExactRay& ray, const OracleBox& box) {
  const auto unit = [&](uint32_t c) { return static_cast<int64_t>(c) << ray.shift; };
  const int64_t s_at_lo = (unit(box.lo[ray.along]) - ray.o_along) * ray.sign;
  const int64_t s_at_hi = (unit(box.hi[ray.along]) - ray.o_along) * ray.sign;
  const int64_t s_lo = min_of(s_at_lo, s_at_hi), s_hi = max_of(s_at_lo, s_at_hi);
  const auto covers = [&](int axis, int64_t origin, int64_t d) {
    const int64_t at_lo = d * s_lo, at_hi = d * s_hi;
    const int64_t lo = (unit(box.lo[axis]) - origin) * (1 << 24) - max_of(at_lo, at_hi);
    const int64_t hi = (unit(box.hi[axis]) - origin) * (1 << 24) - min_of(at_lo, at_hi);
    return static_cast<int>(lo <= 0) & static_cast<int>(hi >= 0);
  };
  // Without branches, so that the tests of several boxes overlap.
  return (static_cast<int>(s_hi >= 0) & covers(ray.first, ray.o_first, ray.d_first) &
          covers(ray.second, ray.o_second, ray.d_second)) != 0;
}

/// Which of the siblings that start at `base` the half-line may touch, as bits.
KD_HD KD_INLINE uint32_t touched_siblings(const OracleView& oracle, const ExactRay& ray, int level, uint32_t base) {
  uint32_t mask = 0;
  for (uint32_t i = 0; i < kOracleFan; ++i) {
    const uint32_t index = min_of(base + i, oracle.count[level] - 1);
    const bool touched = touches(ray, oracle.boxes[oracle.first[level] + index]);
    mask |= static_cast<uint32_t>(touched && index == base + i) << i;
  }
  return mask;
}

/// Calls visit(triangle) for every triangle that the ray's half-line may touch; for all of them with `plainly`.
template <class Visit>
KD_HD void for_each_touched(const OracleView& oracle, const ExactRay& ray, bool plainly, const Visit& visit) {
  if (plainly) {
    for (uint32_t i = 0; i < oracle.triangle_count; ++i) visit(oracle.triangles[i]);
    return;
  }
  uint32_t open[kOracleLevels];  // by level: siblings that are touched and still to be visited
  const int root = oracle.levels - 1;
  int level = root;
  uint32_t base = 0;
  open[root] = touched_siblings(oracle, ray, root, 0);
  while (true) {
    if (open[level] == 0) {
      if (level == root) return;
      ++level;
      base = base / kOracleFan / kOracleFan * kOracleFan;
      continue;
    }
    uint32_t child = 0;
    while ((open[level] >> child & 1) == 0) ++child;
    open[level] &= open[level] - 1;
    const uint32_t index = base + child;
    if (level == 0) {
      visit(oracle.triangles[index]);
      continue;
    }
    --level;
    base = index * kOracleFan;
    open[level] = touched_siblings(oracle, ray, level, base);
  }
}

/// Whether all of b lies in a's plane.
KD_HD inline bool coplanar(const OracleTriangle& a, const OracleTriangle& b) {
  const auto from = [&](Vec3u p) { return vec_cast<int64_t>(p) - vec_cast<int64_t>(a.a); };
  const Vec3<int64_t> n = cross(from(a.b), from(a.c));  // 2^50
  const auto height = [&](Vec3u p) {
    const Vec3<int64_t> r = from(p);
    return static_cast<Wide>(n.x) * r.x + static_cast<Wide>(n.y) * r.y + static_cast<Wide>(n.z) * r.z;
  };
  return height(b.a) == 0 && height(b.b) == 0 && height(b.c) == 0;
}

}  // namespace kd::stress
