#include "build/clip.h"

#include <algorithm>
#include <cmath>

namespace kd::build {

namespace {

constexpr double kWidening = 0x1p-20;

struct Polygon {
  std::array<std::array<double, 3>, 28> points;  // six cuts make 9 of 3, and 28 if rounding conspired at each
  size_t count = 0;

  void push(const std::array<double, 3>& p) { points[count++] = p; }
};

/// What of `in` has sign * coordinate <= sign * plane.
void clip(const Polygon& in, size_t axis, double plane, double sign, Polygon& out) {
  out.count = 0;
  for (size_t i = 0; i < in.count; ++i) {
    const auto& p = in.points[i];
    const auto& q = in.points[i + 1 < in.count ? i + 1 : 0];
    const double dp = sign * (p[axis] - plane), dq = sign * (q[axis] - plane);
    if (dp <= 0) out.push(p);
    if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) {
      const double t = dp / (dp - dq);
      std::array<double, 3> cut;
      for (size_t k = 0; k < 3; ++k) cut[k] = p[k] + t * (q[k] - p[k]);
      cut[axis] = plane;
      out.push(cut);
    }
  }
}

}  // namespace

std::optional<Box3u> clipped_bounds(const LatticeTriangle& triangle, const Box3u& cell) {
  const Box3u whole = bounds(triangle);
  Polygon a, b;
  for (Vec3u p : triangle) a.push({double(p.x), double(p.y), double(p.z)});
  for (size_t axis = 0; axis < 3; ++axis) {
    const int k = static_cast<int>(axis);
    if (whole.lo[k] < cell.lo[k]) {
      clip(a, axis, cell.lo[k] - kWidening, -1, b);
      std::swap(a, b);
    }
    if (whole.hi[k] > cell.hi[k]) {
      clip(a, axis, cell.hi[k] + kWidening, 1, b);
      std::swap(a, b);
    }
  }
  if (a.count == 0) return std::nullopt;

  Box3u box;
  for (size_t axis = 0; axis < 3; ++axis) {
    double lo = a.points[0][axis], hi = lo;
    for (size_t i = 1; i < a.count; ++i) {
      lo = std::min(lo, a.points[i][axis]);
      hi = std::max(hi, a.points[i][axis]);
    }
    const int k = static_cast<int>(axis);
    const double cell_lo = cell.lo[k], cell_hi = cell.hi[k];
    box.lo.set(k, static_cast<uint32_t>(std::clamp(std::floor(lo), cell_lo, cell_hi)));
    box.hi.set(k, static_cast<uint32_t>(std::clamp(std::ceil(hi), cell_lo, cell_hi)));
  }
  return box;
}

}  // namespace kd::build
