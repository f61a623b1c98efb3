#include "pareto/fans.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "pareto/render.h"
#include "sys/parallel.h"

namespace kd::bench {

namespace {

/// For each vertex the first with its position.
std::vector<uint32_t> welded(const std::vector<Vec3d>& positions) {
  std::vector<uint32_t> order(positions.size()), first(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](uint32_t i) { return std::array{positions[i].x, positions[i].y, positions[i].z, double(i)}; };
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
  for (size_t i = 0; i < order.size(); ++i) {
    const bool again = i > 0 && positions[order[i]] == positions[order[i - 1]];
    first[order[i]] = again ? first[order[i - 1]] : order[i];
  }
  return first;
}

/// A corner of a triangle, with the vertices at it and at the next two.
struct Corner {
  uint32_t at, next, last;
  uint32_t triangle, corner;
};

std::vector<Corner> corners_of(const mesh::Mesh& mesh) {
  const std::vector<uint32_t> vertex = welded(mesh.positions);
  std::vector<Corner> corners;
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    for (uint32_t k = 0; k < 3; ++k) {
      const auto& t = mesh.triangles[i];
      corners.push_back({vertex[t[k]], vertex[t[(k + 1) % 3]], vertex[t[(k + 2) % 3]], i, k});
    }
  }
  return corners;
}

/// Whether these corners, at one vertex and sorted by `next`, follow one on another around it once: the last vertex of
/// each is the next vertex of exactly one, and one walk sees them all.
bool is_ring(std::span<const Corner> star) {
  if (star.size() < 3) return false;
  for (size_t i = 1; i < star.size(); ++i) {
    if (star[i].next == star[i - 1].next) return false;
  }
  uint32_t vertex = star[0].next;
  for (size_t steps = 1; steps <= star.size(); ++steps) {
    const auto found = std::lower_bound(star.begin(), star.end(), vertex,
                                        [](const Corner& c, uint32_t next) { return c.next < next; });
    if (found == star.end() || found->next != vertex) return false;
    vertex = found->last;
    if (vertex == star[0].next) return steps == star.size();
  }
  return false;
}

void add_target(const mesh::Mesh& mesh, std::span<const Corner> star, bool is_edge, Targets& out) {
  out.all.push_back({is_edge, static_cast<uint32_t>(out.stars.size()), static_cast<uint32_t>(star.size())});
  for (const Corner& c : star) out.stars.push_back({mesh.source_primitives[c.triangle], c.corner});
}

/// Calls visit(group) for runs of equal `key`s.
template <class Key, class Visit>
void for_each_group(std::span<const Corner> sorted, const Key& key, const Visit& visit) {
  for (size_t begin = 0, end; begin < sorted.size(); begin = end) {
    for (end = begin + 1; end < sorted.size() && key(sorted[end]) == key(sorted[begin]);) ++end;
    visit(sorted.subspan(begin, end - begin));
  }
}

/// The plane across a ray, with the point aimed at as its origin.
class Across {
 public:
  Across(Vec3d aim, Vec3d direction) : aim_(aim) {
    const Vec3d d = normalised(direction);
    const double x = std::fabs(d.x), y = std::fabs(d.y), z = std::fabs(d.z);
    const Vec3d helper = x <= y && x <= z ? Vec3d{1, 0, 0} : y <= z ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
    right_ = normalised(cross(d, helper));
    up_ = cross(right_, d);
  }
  Vec3d place(Vec3d p) const { return {dot(p - aim_, right_), dot(p - aim_, up_), 0}; }

 private:
  Vec3d aim_, right_, up_;
};

double cross_2d(Vec3d a, Vec3d b) { return a.x * b.y - a.y * b.x; }

/// How far the origin is to the left of the line from a to b.
double left_of(Vec3d a, Vec3d b) { return cross_2d(a, b) / length(b - a); }

/// Whether the triangles tile a polygon that has the origin inside, `margin` clear of its border, and all turn the way
/// `side` says (1 or -1).
bool tiles(std::span<const StarTriangle> star, std::span<const Corners> corners, bool is_edge, const Across& across,
           double side, double margin) {
  double turned = 0;
  for (size_t i = 0; i < star.size(); ++i) {
    const Corners& c = corners[i];
    const size_t k = star[i].corner;
    const Vec3d a = across.place(c[k]), b = across.place(c[(k + 1) % 3]), d = across.place(c[(k + 2) % 3]);
    if (!(side * cross_2d(b - a, d - a) > 0) || !(side * left_of(b, d) >= margin)) return false;
    if (is_edge && !(side * left_of(d, a) >= margin)) return false;
    if (!is_edge) turned += std::atan2(side * cross_2d(b, d), dot(b, d));
  }
  return is_edge || std::fabs(turned - 2 * std::numbers::pi) < 1;  // once around, not twice
}

}  // namespace

Targets find_targets(const mesh::Mesh& mesh) {
  Targets out;
  std::vector<Corner> corners = corners_of(mesh);
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    return std::array{a.at, a.next, a.triangle} < std::array{b.at, b.next, b.triangle};
  });
  for_each_group(
      std::span<const Corner>(corners), [](const Corner& c) { return c.at; },
      [&](std::span<const Corner> star) {
        if (is_ring(star)) add_target(mesh, star, false, out);
      });
  const auto edge = [](const Corner& c) { return std::array{std::min(c.at, c.next), std::max(c.at, c.next)}; };
  std::sort(corners.begin(), corners.end(), [&](const Corner& a, const Corner& b) {
    return std::pair(edge(a), a.triangle) < std::pair(edge(b), b.triangle);
  });
  for_each_group(std::span<const Corner>(corners), edge, [&](std::span<const Corner> pair) {
    if (pair.size() == 2 && pair[0].at == pair[1].next && pair[0].at != pair[0].next) add_target(mesh, pair, true, out);
  });
  return out;
}

std::vector<AimedRay> aim(const Targets& targets, Vec3d camera, double diagonal,
                          const std::function<const Corners*(uint32_t primitive)>& corners) {
  std::vector<AimedRay> out;
  std::vector<Corners> around;
  const Vec3d origin = to_ray(record(camera, {0, 0, 1}, 1)).origin;  // as float32 keeps it
  for (uint32_t i = 0; i < targets.all.size(); ++i) {
    const Target& target = targets.all[i];
    const auto star = targets.star(target);
    around.clear();
    for (const StarTriangle& t : star) {
      if (const Corners* c = corners(t.primitive)) around.push_back(*c);
    }
    if (around.size() < star.size()) continue;
    const Vec3d a = around[0][star[0].corner], b = around[0][(star[0].corner + 1) % 3];
    const Vec3d point = target.is_edge ? (a + b) * 0.5 : a;
    // Rounding to float32, in model space or in the lattice, moves a ray by some 2^-23 of this: a 32nd of the margin.
    const double margin = 0x1p-18 * (length(point - origin) + diagonal);
    if (length(point - origin) < 64 * margin) continue;
    const AimedRay aimed{i, record(origin, normalised(point - origin), 1e30f), 0};
    const Ray ray = to_ray(aimed.ray);
    const Across across(point, ray.direction);
    const double side =
        dot(cross(around[0][1] - around[0][0], around[0][2] - around[0][0]), ray.direction) < 0 ? 1 : -1;
    if (!tiles(star, around, target.is_edge, across, side, margin)) continue;
    double nearest = 1e300, farthest = 0;
    for (const Corners& c : around) {
      for (Vec3d p : c) {
        const double t = dot(p - ray.origin, ray.direction) / dot(ray.direction, ray.direction);
        nearest = std::min(nearest, t);
        farthest = std::max(farthest, t);
      }
    }
    if (nearest < margin) continue;
    out.push_back({i, aimed.ray, farthest + margin});
  }
  return out;
}

FanCounts count_fans(const Targets& targets, std::span<const AimedRay> rays, const nkd::ObjectFile& object,
                     render::TriangleTest test) {
  const ObjectTriangles triangles(object);
  const PackedTriangles packed = object.geometry().packed();
  const Lattice& lattice = object.summary().lattice;
  const InverseFrame to_lattice = invert(lattice.frame());
  FanCounts counts{rays.size(), 0, 0};
  render::with_test(test, [&]<class Test>() {
    for (const AimedRay& aimed : rays) {
      LatticeRay ray;
      const render::RayRecord& r = aimed.ray;
      const bool enters = render::lattice_ray<Test::kExact>(to_lattice, lattice.bits, r, ray);
      int met = 0;
      for (const StarTriangle& t : targets.star(targets.all[aimed.target])) {
        TriangleVertices vertices;
        packed.expand(triangles.index_of(t.primitive), vertices);
        typename Test::Distance s;
        NoCounter counter;
        met += enters && Test{ray}.template meets<RayMode::closest>(vertices, ray.s_max, s, counter);
      }
      counts.missed += met == 0;
      counts.twice += met > 1;
    }
  });
  return counts;
}

}  // namespace kd::bench
