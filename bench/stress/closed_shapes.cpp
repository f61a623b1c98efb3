// Shapes without a hole, with a point inside.
#include <map>
#include <numbers>

#include "stress/shape_parts.h"

namespace kd::stress {

namespace {

/// A mesh of indexed points on the lattice, its triangles without area left out.
Shape on_lattice(std::span<const Vec3u> points, std::span<const std::array<uint32_t, 3>> triangles) {
  Shape shape;
  shape.vertices.assign(points.begin(), points.end());
  for (const auto& t : triangles) {
    const auto at = [&](uint32_t i) { return vec_cast<int64_t>(points[i]); };
    if (!(cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0])) == Vec3<int64_t>{0, 0, 0})) shape.triangles.push_back(t);
  }
  return shape;
}

struct Sphere {
  std::vector<Vec3d> points;  // of length 1
  std::vector<std::array<uint32_t, 3>> triangles;
};

/// An icosahedron, its faces quartered `levels` times.
Sphere icosphere(int levels) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  Sphere s;
  s.points = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
              {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  s.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                 {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                 {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (Vec3d& p : s.points) p = normalised(p);
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [entry, fresh] = middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(s.points.size()));
      if (fresh) s.points.push_back(normalised(s.points[a] + s.points[b]));
      return entry->second;
    };
    std::vector<std::array<uint32_t, 3>> finer;
    for (const auto& [a, b, c] : s.triangles) {
      const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    s.triangles = std::move(finer);
  }
  return s;
}

Shape ball_of(int bits, int levels) {
  const Sphere sphere = icosphere(levels);
  const uint32_t top = lattice_max(bits);
  std::vector<Vec3u> points;
  for (Vec3d p : sphere.points) {
    const Vec3d q = (p + Vec3d{1, 1, 1}) * (0.5 * top);
    points.push_back({rounded(q.x, top), rounded(q.y, top), rounded(q.z, top)});
  }
  Shape shape = on_lattice(points, sphere.triangles);
  const double middle = 0.5 * top;
  shape.traits = {true, false, true, false, {middle, middle, middle}, {0.4 * middle, 0.4 * middle, 0.4 * middle}};
  return shape;
}

}  // namespace

/// 40,962 vertices and 81,920 triangles: with every vertex and every triangle's edges aimed at from 8 points, 2,293,776
/// rays.
Shape ball(int bits) { return ball_of(bits, 6); }
Shape small_ball(int bits) { return ball_of(bits, 2); }

/// An axis-aligned box with `cells` rectangles along its edges: 4,610 vertices and 9,216 triangles; with every vertex
/// and every triangle's edges aimed at from 24 points, 774,192 rays.
Shape box(int bits) {
  constexpr Vec3u kCells{16, 24, 48};
  const double top = lattice_max(bits);
  const Vec3d lo{0.1 * top, 0.2 * top, 0}, size{0.7 * top, 0.5 * top, top};
  std::map<std::array<uint32_t, 3>, uint32_t> numbers;
  std::vector<Vec3u> points;
  std::vector<std::array<uint32_t, 3>> triangles;
  const auto point = [&](Vec3u cell) {
    const auto [entry, fresh] = numbers.try_emplace({cell.x, cell.y, cell.z}, static_cast<uint32_t>(points.size()));
    const Vec3d p = lo + size * Vec3d{double(cell.x) / kCells.x, double(cell.y) / kCells.y, double(cell.z) / kCells.z};
    const uint32_t most = lattice_max(bits);
    if (fresh) points.push_back({rounded(p.x, most), rounded(p.y, most), rounded(p.z, most)});
    return entry->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const int along = (axis + 1) % 3, up = (axis + 2) % 3;
    for (uint32_t side = 0; side < 2; ++side) {
      for (uint32_t i = 0; i < kCells[along]; ++i) {
        for (uint32_t j = 0; j < kCells[up]; ++j) {
          const auto corner = [&](uint32_t di, uint32_t dj) {
            Vec3u cell;
            cell.set(axis, side * kCells[axis]);
            cell.set(along, i + di);
            cell.set(up, j + dj);
            return point(cell);
          };
          const uint32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          // Diagonals alternate; the winding is outward.
          const bool slash = (i + j) % 2 == 0;
          std::array<uint32_t, 3> first = slash ? std::array{a, b, c} : std::array{a, b, d};
          std::array<uint32_t, 3> second = slash ? std::array{a, c, d} : std::array{b, c, d};
          if (side == 0) {
            std::swap(first[1], first[2]);
            std::swap(second[1], second[2]);
          }
          triangles.insert(triangles.end(), {first, second});
        }
      }
    }
  }
  Shape shape = on_lattice(points, triangles);
  shape.traits = {true, true, true, false, lo + size * 0.5, size * 0.3};
  return shape;
}

/// A regular tetrahedron whose slanted faces are tessellated in points that lie on them exactly.
Shape tetrahedron(int bits) {
  constexpr uint32_t kCells = 8;
  const uint32_t edge = 1u << (bits - 1), step = edge / kCells;
  const std::array<Vec3u, 4> corners{Vec3u{0, 0, 0}, {edge, edge, 0}, {edge, 0, edge}, {0, edge, edge}};
  constexpr std::array<std::array<size_t, 3>, 4> kFaces{{{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
  Shape shape;
  for (const auto& face : kFaces) {
    const auto at = [&](uint32_t i, uint32_t j) {
      Vec3u p;
      for (int axis = 0; axis < 3; ++axis) {
        const uint32_t a = corners[face[0]][axis] / edge, b = corners[face[1]][axis] / edge,
                       c = corners[face[2]][axis] / edge;
        p.set(axis, (a * (kCells - i - j) + b * i + c * j) * step);
      }
      return p;
    };
    for (uint32_t i = 0; i < kCells; ++i) {
      for (uint32_t j = 0; i + j < kCells; ++j) {
        add_triangle(shape, at(i, j), at(i + 1, j), at(i, j + 1));
        if (i + j + 1 < kCells) add_triangle(shape, at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
    }
  }
  const double middle = 0.5 * edge, size = 0.1 * edge;
  shape.traits = {true, true, true, false, {middle, middle, middle}, {size, size, size}};
  return shape;
}

namespace {

/// Two fans of `rim` triangles, base to base: a double cone.
Shape fan_of(int bits, uint32_t rim) {
  const uint32_t top = lattice_max(bits), middle = top / 2;
  std::vector<Vec3u> points{{middle, middle, 0}, {middle, middle, top}};
  std::vector<std::array<uint32_t, 3>> triangles;
  for (uint32_t i = 0; i < rim; ++i) {
    const double angle = 2 * std::numbers::pi * i / rim;
    points.push_back(
        {rounded(middle + middle * std::cos(angle), top), rounded(middle + middle * std::sin(angle), top), middle});
  }
  for (uint32_t i = 0; i < rim; ++i) {
    const uint32_t a = 2 + i, b = 2 + (i + 1) % rim;
    triangles.push_back({1, a, b});
    triangles.push_back({0, b, a});
  }
  Shape shape = on_lattice(points, triangles);
  const double m = middle, size = 0.2 * m;
  shape.traits = {true, false, true, false, {m, m, m}, {size, size, size}};
  return shape;
}

}  // namespace

Shape fan(int bits) { return fan_of(bits, 65536); }
Shape small_fan(int bits) { return fan_of(bits, 128); }

mesh::Mesh offset_ball() {
  const Sphere sphere = icosphere(6);
  mesh::Mesh mesh;
  for (Vec3d p : sphere.points) {
    const Vec3d q = Vec3d{148376, 1234, -223423} + p * 2.0;
    mesh.positions.push_back(vec_cast<double>(vec_cast<float>(q)));
  }
  mesh.triangles = sphere.triangles;
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) mesh.source_primitives.push_back(i);
  return mesh;
}

}  // namespace kd::stress
