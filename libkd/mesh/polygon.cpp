#include "mesh/polygon.h"

#include <cmath>
#include <numeric>

namespace kd::mesh {
namespace {

struct Point {
  double x, y;
};

double turn(Point a, Point b, Point c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

/// The corners seen along the largest component of the polygon's normal (Newell's), counterclockwise.
std::vector<Point> project(std::span<const Vec3d> corners) {
  Vec3d normal;
  for (size_t i = 0; i < corners.size(); ++i) {
    const Vec3d a = corners[i] - corners[0], b = corners[(i + 1) % corners.size()] - corners[0];
    normal = normal + cross(a, b);
  }
  const double ax = std::fabs(normal.x), ay = std::fabs(normal.y), az = std::fabs(normal.z);
  const int along = ax >= ay && ax >= az ? 0 : ay >= az ? 1 : 2;
  const bool from_behind = normal[along] < 0;
  const int u = (along + (from_behind ? 2 : 1)) % 3, v = (along + (from_behind ? 1 : 2)) % 3;
  std::vector<Point> points;
  points.reserve(corners.size());
  for (const Vec3d& p : corners) points.push_back({p[u] - corners[0][u], p[v] - corners[0][v]});
  return points;
}

bool is_convex(const std::vector<Point>& p) {
  for (size_t i = 0; i < p.size(); ++i) {
    if (turn(p[i], p[(i + 1) % p.size()], p[(i + 2) % p.size()]) < 0) return false;
  }
  return true;
}

/// Whether corner `i` of the remaining polygon turns left with no other corner in its triangle. Corners that lie where
/// one of the triangle's own do (a bridge to a hole) do not block it.
bool is_ear(const std::vector<Point>& p, const std::vector<uint32_t>& left, size_t i) {
  const size_t n = left.size();
  const Point a = p[left[(i + n - 1) % n]], b = p[left[i]], c = p[left[(i + 1) % n]];
  if (!(turn(a, b, c) > 0)) return false;
  const auto same = [](Point q, Point r) { return q.x == r.x && q.y == r.y; };
  for (size_t k = 2; k + 1 < n; ++k) {
    const Point q = p[left[(i + k) % n]];
    if (same(q, a) || same(q, b) || same(q, c)) continue;
    if (turn(a, b, q) >= 0 && turn(b, c, q) >= 0 && turn(c, a, q) >= 0) return false;
  }
  return true;
}

}  // namespace

void triangulate_polygon(std::span<const Vec3d> corners, std::vector<std::array<uint32_t, 3>>& triangles) {
  triangles.clear();
  const auto count = static_cast<uint32_t>(corners.size());
  const auto fan = [&] {
    for (uint32_t i = 2; i < count; ++i) triangles.push_back({0, i - 1, i});
  };
  if (count <= 3 || count > kMostClippedCorners) return fan();
  const std::vector<Point> points = project(corners);
  if (is_convex(points)) return fan();

  std::vector<uint32_t> left(count);
  std::iota(left.begin(), left.end(), 0u);
  size_t i = 0;
  while (left.size() > 3) {
    const size_t n = left.size();
    size_t tried = 0;
    while (tried < n && !is_ear(points, left, i % n)) {
      ++i;
      ++tried;
    }
    i %= n;
    triangles.push_back({left[(i + n - 1) % n], left[i], left[(i + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
  }
  triangles.push_back({left[0], left[1], left[2]});
}

}  // namespace kd::mesh
