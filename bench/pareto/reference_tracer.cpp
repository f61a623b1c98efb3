#include "pareto/reference_tracer.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kd::bench {

namespace {

constexpr uint32_t kLeafTriangles = 4;
constexpr int kStack = 64;  // halves of at most 2^32 triangles

int largest_axis(Vec3d v) { return v.x >= v.y && v.x >= v.z ? 0 : v.y >= v.z ? 1 : 2; }

/// Where a ray passes a box; enter > leave: nowhere. A component of 0 stands in as one that is too small to matter,
/// which makes no NaN.
struct Slabs {
  Vec3d origin, inverse;

  explicit Slabs(const Ray& ray)
      : origin(ray.origin), inverse{invert(ray.direction.x), invert(ray.direction.y), invert(ray.direction.z)} {}

  /// Rounding of each distance is at most 3 * 2^-53 of it; the factor outdoes it on either end (Ize, "Robust BVH Ray
  /// Traversal", JCGT 2013).
  bool pass(const Box3d& box, double t_min, double t_max, double& enter) const {
    enter = t_min;
    double leave = t_max;
    for (int axis = 0; axis < 3; ++axis) {
      const double t0 = (box.lo[axis] - origin[axis]) * inverse[axis];
      const double t1 = (box.hi[axis] - origin[axis]) * inverse[axis];
      enter = std::max(enter, std::min(t0, t1));
      leave = std::min(leave, std::max(t0, t1));
    }
    return enter * (enter > 0 ? 1 - 0x1p-50 : 1 + 0x1p-50) <= leave * (leave > 0 ? 1 + 0x1p-50 : 1 - 0x1p-50);
  }

 private:
  static double invert(double c) { return std::fabs(c) > 1e-150 ? 1 / c : std::copysign(1e150, c); }
};

double squared_distance(const Box3d& box, Vec3d p) {
  const auto outside = [](double lo, double hi, double x) { return std::max({lo - x, 0.0, x - hi}); };
  const Vec3d d{outside(box.lo.x, box.hi.x, p.x), outside(box.lo.y, box.hi.y, p.y), outside(box.lo.z, box.hi.z, p.z)};
  return dot(d, d);
}

}  // namespace

bool meets(const Ray& ray, const Corners& corners, ReferenceHit& hit) {
  const Vec3d size{std::fabs(ray.direction.x), std::fabs(ray.direction.y), std::fabs(ray.direction.z)};
  const int k = largest_axis(size), i = (k + 1) % 3, j = (k + 2) % 3;
  const double along = ray.direction[k], slope_i = ray.direction[i] / along, slope_j = ray.direction[j] / along;
  double x[3], y[3], z[3];
  for (size_t c = 0; c < 3; ++c) {
    const Vec3d r = corners[c] - ray.origin;
    x[c] = r[i] - slope_i * r[k];
    y[c] = r[j] - slope_j * r[k];
    z[c] = r[k];
  }
  const double u = x[2] * y[0] - y[2] * x[0], v = x[0] * y[1] - y[0] * x[1], w = x[1] * y[2] - y[1] * x[2];
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
  const double sum = u + v + w;
  if (sum == 0) return false;
  hit.u = u / sum;
  hit.v = v / sum;
  hit.t = (w * z[0] + u * z[1] + v * z[2]) / sum / along;
  return true;
}

// Ericson, "Real-Time Collision Detection", 2005, section 5.1.5: by the regions of the triangle's plane.
Vec3d nearest_point(const Corners& corners, Vec3d p) {
  const auto [a, b, c] = corners;
  const Vec3d ab = b - a, ac = c - a;
  const double d1 = dot(ab, p - a), d2 = dot(ac, p - a);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = dot(ab, p - b), d4 = dot(ac, p - b);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
  const double d5 = dot(ab, p - c), d6 = dot(ac, p - c);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  const double sum = va + vb + vc;
  return a + ab * (vb / sum) + ac * (vc / sum);
}

ReferenceTracer::ReferenceTracer(std::vector<Corners> triangles) : triangles_(std::move(triangles)) {
  order_.resize(triangles_.size());
  std::iota(order_.begin(), order_.end(), 0u);
  std::vector<Vec3d> centres;
  centres.reserve(triangles_.size());
  Box3d whole;
  for (const Corners& c : triangles_) {
    centres.push_back((c[0] + c[1] + c[2]) * (1.0 / 3));
    for (Vec3d p : c) whole.extend(p);
  }
  const auto largest = [](Vec3d p) { return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}); };
  margin_ = 0x1p-36 * (length(whole.extent()) + std::max(largest(whole.lo), largest(whole.hi)));
  nodes_.reserve(2 * triangles_.size());
  nodes_.emplace_back();
  build(0, 0, static_cast<uint32_t>(order_.size()), centres);
}

void ReferenceTracer::build(uint32_t node, uint32_t begin, uint32_t end, const std::vector<Vec3d>& centres) {
  Box3d box, centre_box;
  for (uint32_t i = begin; i < end; ++i) {
    for (Vec3d p : triangles_[order_[i]]) box.extend(p);
    centre_box.extend(centres[order_[i]]);
  }
  const Vec3d margin{margin_, margin_, margin_};
  nodes_[node].box = {box.lo - margin, box.hi + margin};
  nodes_[node].first = begin;
  nodes_[node].count = end - begin;
  if (end - begin <= kLeafTriangles) return;

  const int axis = largest_axis(centre_box.extent());
  const uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](uint32_t a, uint32_t b) { return centres[a][axis] < centres[b][axis]; });
  const auto children = static_cast<uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node].first = children;
  nodes_[node].count = 0;
  build(children, begin, middle, centres);
  build(children + 1, middle, end, centres);
}

template <class Visit>
void ReferenceTracer::along(const Ray& ray, const double& t_limit, const Visit& visit) const {
  const Slabs slabs(ray);
  struct Entry {
    uint32_t node;
    double enter;
  };
  Entry stack[kStack];
  int open = 0;
  if (double enter; slabs.pass(nodes_[0].box, ray.t_min, t_limit, enter)) stack[open++] = {0, enter};
  while (open > 0) {
    const Entry entry = stack[--open];
    if (entry.enter > t_limit) continue;
    const Node& node = nodes_[entry.node];
    for (uint32_t i = node.first; i < node.first + node.count; ++i) {
      if (!visit(order_[i])) return;
    }
    if (node.count > 0) continue;
    double enter_a, enter_b;
    const bool pass_a = slabs.pass(nodes_[node.first].box, ray.t_min, t_limit, enter_a);
    const bool pass_b = slabs.pass(nodes_[node.first + 1].box, ray.t_min, t_limit, enter_b);
    const bool b_first = pass_b && enter_b < enter_a;
    if (pass_b && !b_first) stack[open++] = {node.first + 1, enter_b};
    if (pass_a) stack[open++] = {node.first, enter_a};
    if (pass_b && b_first) stack[open++] = {node.first + 1, enter_b};
  }
}

ReferenceHit ReferenceTracer::closest_hit(const Ray& ray) const {
  ReferenceHit best;
  double t_limit = ray.t_max;
  along(ray, t_limit, [&](uint32_t triangle) {
    ReferenceHit hit;
    if (!meets(ray, triangles_[triangle], hit) || hit.t < ray.t_min || hit.t > t_limit) return true;
    if (hit.t == t_limit && best.triangle >= 0 && best.triangle < triangle) return true;
    t_limit = hit.t;
    best = hit;
    best.triangle = triangle;
    return true;
  });
  return best;
}

bool ReferenceTracer::any_hit(const Ray& ray) const {
  bool met = false;
  along(ray, ray.t_max, [&](uint32_t triangle) {
    ReferenceHit hit;
    met = meets(ray, triangles_[triangle], hit) && hit.t >= ray.t_min && hit.t <= ray.t_max;
    return !met;
  });
  return met;
}

double ReferenceTracer::distance(Vec3d p, double limit) const {
  double nearest = limit * limit;
  struct Entry {
    uint32_t node;
    double squared;
  };
  Entry stack[kStack];
  int open = 0;
  stack[open++] = {0, squared_distance(nodes_[0].box, p)};
  while (open > 0) {
    const Entry entry = stack[--open];
    if (entry.squared >= nearest) continue;
    const Node& node = nodes_[entry.node];
    for (uint32_t i = node.first; i < node.first + node.count; ++i) {
      const Vec3d away = nearest_point(triangles_[order_[i]], p) - p;
      nearest = std::min(nearest, dot(away, away));
    }
    if (node.count > 0) continue;
    const Entry a{node.first, squared_distance(nodes_[node.first].box, p)};
    const Entry b{node.first + 1, squared_distance(nodes_[node.first + 1].box, p)};
    stack[open++] = a.squared < b.squared ? b : a;
    stack[open++] = a.squared < b.squared ? a : b;
  }
  return std::sqrt(nearest);
}

}  // namespace kd::bench
