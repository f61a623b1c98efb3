// Meshes on the lattice, the trees over them, and rays to aim at them; shared by the suites core, build, nkd and
// render.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "build/build.h"
#include "core/lattice.h"
#include "core/object_view.h"
#include "core/traversal.h"

namespace kd::test {

/// The same numbers on every machine: the distributions of <random> are not.
class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  /// In [0, 1).
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double real(double lo, double hi) { return lo + unit() * (hi - lo); }
  /// In [lo, hi].
  uint32_t integer(uint32_t lo, uint32_t hi) { return lo + static_cast<uint32_t>(engine_() % (uint64_t{hi} - lo + 1)); }
  bool chance(double p) { return unit() < p; }
  Vec3d vector(double size) { return {real(-size, size), real(-size, size), real(-size, size)}; }
  Vec3u point(uint32_t top) { return {integer(0, top), integer(0, top), integer(0, top)}; }

 private:
  std::mt19937_64 engine_;
};

struct Shape {
  std::vector<Vec3u> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;

  uint32_t add(Vec3u v) {
    vertices.push_back(v);
    return static_cast<uint32_t>(vertices.size() - 1);
  }
  void add_triangle(Vec3u a, Vec3u b, Vec3u c) {
    const uint32_t i = add(a), j = add(b), k = add(c);
    triangles.push_back({i, j, k});
  }
  /// The rectangle between two opposite corners of a flat box, as two triangles.
  void add_wall(Vec3u lo, Vec3u hi) {
    const int flat = lo.x == hi.x ? 0 : lo.y == hi.y ? 1 : 2;
    const int along = (flat + 1) % 3;
    Vec3u p = lo, q = hi;
    p.set(along, hi[along]);
    q.set(along, lo[along]);
    add_triangle(lo, p, hi);
    add_triangle(lo, hi, q);
  }
  std::array<Vec3u, 3> corners(size_t i) const {
    const auto& t = triangles[i];
    return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
  }
};

inline uint32_t clamp_to(double v, uint32_t top) {
  return static_cast<uint32_t>(std::fmin(std::fmax(std::nearbyint(v), 0.0), top));
}

/// A closed box, faces outward, its corners shared.
inline Shape box_shape(Vec3u lo, Vec3u hi) {
  Shape s;
  for (int i = 0; i < 8; ++i) s.add({i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z});
  s.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return s;
}

/// An icosahedron, its faces quartered `levels` times, its points on the sphere that touches the cube, rounded.
inline Shape sphere_shape(int bits, int levels) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vec3d> p{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                       {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  std::vector<std::array<uint32_t, 3>> t{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                         {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                         {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                         {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [entry, fresh] = middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(p.size()));
      if (fresh) p.push_back(normalised(p[a]) + normalised(p[b]));
      return entry->second;
    };
    std::vector<std::array<uint32_t, 3>> finer;
    for (const auto& [a, b, c] : t) {
      const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    t = std::move(finer);
  }
  Shape s;
  const uint32_t top = lattice_max(bits);
  for (Vec3d v : p) {
    const Vec3d q = (normalised(v) + Vec3d{1, 1, 1}) * (0.5 * top);
    s.add({clamp_to(q.x, top), clamp_to(q.y, top), clamp_to(q.z, top)});
  }
  s.triangles = std::move(t);
  return s;
}

/// A double cone: two fans of `count` triangles each about the axis x = y = middle.
inline Shape fan_shape(int bits, uint32_t count) {
  const uint32_t top = lattice_max(bits), middle = top / 2;
  Shape s;
  s.add({middle, middle, 0});
  s.add({middle, middle, top});
  for (uint32_t i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    s.add({clamp_to(middle + middle * std::cos(angle), top), clamp_to(middle + middle * std::sin(angle), top), middle});
  }
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t a = 2 + i, b = 2 + (i + 1) % count;
    s.triangles.push_back({1, a, b});
    s.triangles.push_back({0, b, a});
  }
  return s;
}

enum class Soup { large, small, needles, mixed };

inline Shape soup_shape(int bits, uint32_t count, Soup kind, uint64_t seed) {
  Random random(seed);
  const uint32_t top = lattice_max(bits);
  Shape s;
  while (s.triangles.size() < count) {
    Soup k = kind;
    if (k == Soup::mixed) k = std::array{Soup::large, Soup::small, Soup::needles}[random.integer(0, 2)];
    const auto near = [&](Vec3u p, double size) {
      const Vec3d q = vec_cast<double>(p) + random.vector(size);
      return Vec3u{clamp_to(q.x, top), clamp_to(q.y, top), clamp_to(q.z, top)};
    };
    const Vec3u a = random.point(top), b = k == Soup::small ? near(a, top * 0.02 + 2) : random.point(top);
    const Vec3u c = k == Soup::large ? random.point(top) : near(a, k == Soup::small ? top * 0.02 + 2 : 2);
    const auto ab = vec_cast<int64_t>(b) - vec_cast<int64_t>(a), ac = vec_cast<int64_t>(c) - vec_cast<int64_t>(a);
    if (!(cross(ab, ac) == Vec3<int64_t>{0, 0, 0})) s.add_triangle(a, b, c);
  }
  return s;
}

/// n x n x n rooms between walls that lie in lattice planes, some of them left out: doors.
inline Shape rooms_shape(int bits, uint32_t n, uint64_t seed) {
  Random random(seed);
  const uint32_t top = lattice_max(bits);
  Shape s;
  const auto at = [&](uint32_t i) { return static_cast<uint32_t>(uint64_t{top} * i / n); };
  for (int axis = 0; axis < 3; ++axis) {
    for (uint32_t i = 0; i <= n; ++i) {
      for (uint32_t j = 0; j < n; ++j) {
        for (uint32_t k = 0; k < n; ++k) {
          if (i > 0 && i < n && random.chance(0.3)) continue;
          Vec3u lo, hi;
          lo.set(axis, at(i));
          hi.set(axis, at(i));
          lo.set((axis + 1) % 3, at(j));
          hi.set((axis + 1) % 3, at(j + 1));
          lo.set((axis + 2) % 3, at(k));
          hi.set((axis + 2) % 3, at(k + 1));
          s.add_wall(lo, hi);
        }
      }
    }
  }
  return s;
}

/// Boxes that stand on each other and side by side, faces coincident.
inline Shape stacked_boxes_shape(int bits, uint32_t n) {
  const uint32_t top = lattice_max(bits);
  Shape s;
  for (uint32_t i = 0; i < n * n * n; ++i) {
    const Vec3u cell{i % n, i / n % n, i / (n * n)};
    if ((cell.x + cell.y + cell.z) % 3 == 2) continue;
    const auto at = [&](uint32_t c) { return static_cast<uint32_t>(uint64_t{top} * c / n); };
    const Shape box = box_shape({at(cell.x), at(cell.y), at(cell.z)}, {at(cell.x + 1), at(cell.y + 1), at(cell.z + 1)});
    const auto base = static_cast<uint32_t>(s.vertices.size());
    s.vertices.insert(s.vertices.end(), box.vertices.begin(), box.vertices.end());
    for (const auto& [a, b, c] : box.triangles) s.triangles.push_back({base + a, base + b, base + c});
  }
  return s;
}

inline Lattice cube_lattice(int bits) {
  const double e = lattice_max(bits);
  return {{0, 0, 0}, {e, e, e}, bits};
}

inline TriangleVertices expanded(const std::array<Vec3u, 3>& t) {
  return {vec_cast<float>(t[0]), 0, vec_cast<float>(t[1]), 0, vec_cast<float>(t[2]), 0};
}

inline std::vector<TriangleVertices> expanded(const Shape& shape) {
  std::vector<TriangleVertices> all;
  for (size_t i = 0; i < shape.triangles.size(); ++i) all.push_back(expanded(shape.corners(i)));
  return all;
}

/// A shape under its tree, ready to traverse; model space is lattice space.
struct Traced {
  Shape shape;
  Lattice lattice;
  build::Tree tree;
  std::vector<TriangleVertices> triangles;

  Traced(Shape s, int bits, const build::BuildSettings& settings = {})
      : shape(std::move(s)), lattice(cube_lattice(bits)), triangles(expanded(shape)) {
    tree = *build::build_tree(lattice, shape.vertices, shape.triangles, settings);
  }
  ObjectView view() const { return {tree.nodes.data(), tree.references.data(), triangles.data(), lattice.bits}; }
};

/// The nearest hit by looking at every triangle: distance, then index.
inline uint32_t brute_force(std::span<const TriangleVertices> triangles, const LatticeRay& ray, float s_limit,
                            uint32_t excluded) {
  uint32_t best = kNoTriangle;
  double nearest = std::fmin(ray.s_max, s_limit);
  const ExactTest test(ray);
  NoCounter counter;
  for (uint32_t i = 0; i < triangles.size(); ++i) {
    double s;
    if (i == excluded || !test.meets<RayMode::closest>(triangles[i], 0, s, counter)) continue;
    if (s < ray.s_min || s > nearest || (s == nearest && best != kNoTriangle)) continue;
    nearest = s;
    best = i;
  }
  return best;
}

struct PlainRay {
  Vec3d origin, direction;
};

/// Rays at a shape, of the kinds that lose hits: at vertices and edges, along planes, axis-parallel ones, grazing ones.
inline PlainRay adversarial_ray(const Shape& shape, int bits, Random& random) {
  const double top = lattice_max(bits);
  const auto& t = shape.corners(random.integer(0, static_cast<uint32_t>(shape.triangles.size() - 1)));
  const Vec3d a = vec_cast<double>(t[0]), b = vec_cast<double>(t[1]), c = vec_cast<double>(t[2]);
  const std::array<Vec3d, 4> targets{a, (a + b) * 0.5, (a + b + c) * (1.0 / 3), a * 0.2 + b * 0.5 + c * 0.3};
  const Vec3d target = targets[random.integer(0, 3)];
  const Vec3d other =
      vec_cast<double>(shape.vertices[random.integer(0, static_cast<uint32_t>(shape.vertices.size() - 1))]);
  switch (random.integer(0, 6)) {
    case 0: {  // parallel to an axis
      const int axis = static_cast<int>(random.integer(0, 2));
      Vec3d d, o = target;
      d.set(axis, random.chance(0.5) ? 1 : -1);
      if (random.chance(0.7)) o.set(axis, d[axis] > 0 ? -top : 2 * top);
      return {o, d};
    }
    case 1: {  // in an axis plane
      const int axis = static_cast<int>(random.integer(0, 2));
      Vec3d d = random.vector(1);
      d.set(axis, 0);
      return {target - d * (2 * top), d};
    }
    case 2: {  // along a diagonal, whose slopes are exact
      const auto sign = [&] { return random.chance(0.5) ? 1.0 : random.chance(0.5) ? -1.0 : 0.5; };
      const Vec3d d{sign(), sign(), sign()};
      return {target - d * std::floor(2 * top), d};
    }
    case 3:  // from vertex to vertex, and past it
      return {other - (target - other) * (random.chance(0.5) ? 1.0 : 0.0), target - other};
    case 4: {  // nearly parallel to an axis
      const int axis = static_cast<int>(random.integer(0, 2));
      Vec3d d = random.vector(1e-7);
      d.set(axis, 1);
      return {target - d * (3 * top), d};
    }
    case 5: {  // from far away
      const Vec3d d = random.vector(1);
      return {target - d * (top * 1e6), d * random.real(0.001, 1000)};
    }
    default: {
      const Vec3d o = random.vector(2 * top);
      return {o, target - o};
    }
  }
}

}  // namespace kd::test
