// The lattice and where vertices go on it: faces stay put, nothing tears, and the error is a number.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "core/lattice.h"
#include "mesh/lattice_fit.h"
#include "mesh/normalise.h"
#include "mesh/scattered.h"
#include "sys/parallel.h"

using namespace kd;
using namespace kd::mesh;
using kd::test::scattered;

namespace {

LatticeFit fit_of(const Mesh& mesh) {
  const Mesh* const meshes[] = {&mesh};
  return LatticeFit(meshes);
}

void add_triangle(Mesh& mesh, Vec3d a, Vec3d b, Vec3d c) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {a, b, c});
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.source_primitives.push_back(static_cast<uint32_t>(mesh.triangles.size() - 1));
}

/// A bumpy sphere, corners not shared by index.
Mesh pebble() {
  Mesh mesh;
  const auto at = [](int i, int j) {
    const double u = i * 0.1, v = j * M_PI / 30, r = 1 + 0.05 * std::sin(3 * u) * std::sin(5 * v);
    return Vec3d{r * std::sin(v) * std::cos(u), r * std::sin(v) * std::sin(u), r * std::cos(v)};
  };
  for (int i = 0; i < 62; ++i) {
    for (int j = 1; j < 29; ++j) {
      add_triangle(mesh, at(i, j), at(i + 1, j), at(i, j + 1));
      add_triangle(mesh, at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return mesh;
}

/// Of the corners' displacement out of their triangles' planes: root mean square, by area, longest steps.
double out_of_planes(const Mesh& mesh, const Lattice& lattice, const std::vector<Vec3u>& points) {
  double sum = 0, areas = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3d a = mesh.positions[t[0]];
    const Vec3d n = cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a);
    const double area = length(n);
    for (uint32_t v : t) {
      const double off = dot(n, lattice.to_model(points[v]) - mesh.positions[v]) / area;
      sum += area * off * off;
    }
    areas += 3 * area;
  }
  const Vec3d s = lattice.step();
  return std::sqrt(sum / areas) / std::max({s.x, s.y, s.z});
}

std::vector<Vec3u> nearest(const Mesh& mesh, const Lattice& lattice) {
  std::vector<Vec3u> points;
  for (const Vec3d& p : mesh.positions) points.push_back(lattice.to_lattice(p));
  return points;
}

/// Two sheets across each axis at odd places within a box, larger than all else.
Mesh shelves() {
  Mesh mesh = scattered(5);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double at : {0.1234567, 0.7654321}) {
      const auto p = [&](double u, double v) {
        return axis == 0 ? Vec3d{at, u, v} : axis == 1 ? Vec3d{u, at, v} : Vec3d{u, v, at};
      };
      add_triangle(mesh, p(0, 0), p(1, 0), p(1, 1));
      add_triangle(mesh, p(0, 0), p(1, 1), p(0, 1));
    }
  }
  return mesh;
}

}  // namespace

TEST_CASE("lattice fit: the box contains the mesh, and grows by two steps at most, only for planes") {
  for (const int bits : {1, 4, 9, 10, 16, 21, 24}) {
    const Mesh mesh = shelves();
    const Box3d tight = bounds(mesh);
    const Lattice lattice = fit_of(mesh).lattice(bits);
    bool grown = false;
    for (int axis = 0; axis < 3; ++axis) {
      const double lo = lattice.origin[axis], hi = lo + lattice.extent[axis], step = lattice.step()[axis];
      CHECK(lo <= tight.lo[axis]);
      CHECK(hi >= tight.hi[axis] - 1e-15);
      CHECK(lattice.extent[axis] <= tight.extent()[axis] + kMostGrowth * step * (1 + 1e-9));
      grown |= lattice.extent[axis] != tight.extent()[axis];
    }
    CHECK(grown == (bits >= kFewestUsefulBits));

    const Mesh none = pebble();
    CHECK(fit_of(none).lattice(bits).origin == bounds(none).lo);
    CHECK(fit_of(none).lattice(bits).extent == bounds(none).extent());
  }
}

TEST_CASE("lattice fit: large planes come near to lattice planes") {
  const Mesh mesh = shelves();
  const LatticeFit fit = fit_of(mesh);
  for (const int bits : {10, 16, 21, 24}) {
    const Lattice lattice = fit.lattice(bits);
    for (const double at : {0.1234567, 0.7654321}) {
      const Vec3d p = lattice.to_lattice_space({at, at, at});
      for (int axis = 0; axis < 3; ++axis) CHECK(std::fabs(p[axis] - std::nearbyint(p[axis])) < 0.1);
    }
  }
}

TEST_CASE("lattice fit: what lies on a lattice stays on it, and where it is") {
  Mesh mesh = scattered(7);
  const Vec3d origin{-17.25, 1234.5, 1e-3}, extent{3.5, 0.7, 11};
  for (const int bits : {10, 16, 21}) {
    const Lattice lattice{origin, extent, bits};
    std::vector<Vec3u> points;
    Mesh on_it = mesh;
    for (Vec3d& p : on_it.positions) {
      const double top = lattice_max(bits);
      points.push_back(vec_cast<uint32_t>(Vec3d{std::rint(p.x * top), std::rint(p.y * top), std::rint(p.z * top)}));
      p = lattice.to_model(points.back());
    }
    const LatticeFit fit = fit_of(on_it);
    const Lattice found = fit.lattice(bits);
    CHECK(found.origin == bounds(on_it).lo);
    CHECK(found.extent == bounds(on_it).extent());
    CHECK(fit.place(0, found) == points);
  }
}

TEST_CASE("lattice fit: faces stay nearer to where they were than by rounding, vertices within a step an axis") {
  for (const Mesh& mesh : {pebble(), shelves(), scattered(9)}) {
    const LatticeFit fit = fit_of(mesh);
    for (const int bits : {10, 16, 21, 24}) {
      const Lattice lattice = fit.lattice(bits);
      const auto points = fit.place(0, lattice);
      for (size_t v = 0; v < points.size(); ++v) {
        const Vec3d off = vec_cast<double>(points[v]) - lattice.to_lattice_space(mesh.positions[v]);
        REQUIRE(std::max({std::fabs(off.x), std::fabs(off.y), std::fabs(off.z)}) <= 1);
        REQUIRE(std::max({points[v].x, points[v].y, points[v].z}) <= lattice_max(bits));
      }
      CHECK(out_of_planes(mesh, lattice, points) <= out_of_planes(mesh, lattice, nearest(mesh, lattice)));
    }
  }
  const Mesh scan = pebble();
  const LatticeFit fit = fit_of(scan);
  const Lattice lattice = fit.lattice(21);
  CHECK(out_of_planes(scan, lattice, fit.place(0, lattice)) <
        0.6 * out_of_planes(scan, lattice, nearest(scan, lattice)));
}

TEST_CASE("lattice fit: an edge across an axis stays across it") {
  Mesh terrain;  // whose rows lie between lattice planes
  const auto at = [](int i, int j) { return Vec3d{i / 7.3, j / 11.7, 0.3 * std::sin(i * 1.7) * std::cos(j * 0.9)}; };
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      add_triangle(terrain, at(i, j), at(i + 1, j), at(i, j + 1));
      add_triangle(terrain, at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  const LatticeFit fit = fit_of(terrain);
  for (const int bits : {10, 16, 21}) {
    const Lattice lattice = fit.lattice(bits);
    const auto points = fit.place(0, lattice), rounded = nearest(terrain, lattice);
    for (size_t v = 0; v < points.size(); ++v) {
      REQUIRE(points[v].x == rounded[v].x);
      REQUIRE(points[v].y == rounded[v].y);
    }
  }
}

TEST_CASE("lattice fit: equal vertices have one point, in one mesh or in several, and any number of threads finds it") {
  const Mesh whole = pebble();
  Mesh halves[2];
  for (size_t t = 0; t < whole.triangles.size(); ++t) {
    const auto& corners = whole.triangles[t];
    add_triangle(halves[t % 2], whole.positions[corners[0]], whole.positions[corners[1]], whole.positions[corners[2]]);
  }
  for (Vec3d& p : halves[1].positions) p = p + Vec3d{-0.0, -0.0, -0.0};
  const Mesh* const both[] = {&halves[0], &halves[1]};
  const LatticeFit together(both), alone = fit_of(whole);
  for (const int bits : {10, 21}) {
    const Lattice lattice = alone.lattice(bits);
    CHECK(together.lattice(bits).origin == lattice.origin);
    CHECK(together.lattice(bits).extent == lattice.extent);
    std::vector<std::vector<Vec3u>> points;
    {
      const ThreadLimit one(1);
      points = {together.place(0, lattice), together.place(1, lattice)};
    }
    CHECK(together.place(0, lattice) == points[0]);
    for (size_t h = 0; h < 2; ++h) {
      for (size_t v = 0; v < points[h].size(); ++v) {
        for (size_t w = 0; w < points[0].size(); w += 17) {
          if (halves[h].positions[v] == halves[0].positions[w]) REQUIRE(points[h][v] == points[0][w]);
        }
      }
    }
  }
}

TEST_CASE("lattice fit: flat, tiny, huge and far-away meshes, needles, and positions that nothing uses") {
  for (const double size : {1e-200, 1e-30, 1.0, 1e30, 1e150}) {
    for (const Vec3d at : {Vec3d{0, 0, 0}, Vec3d{1e6, -1e6, 1e6}}) {
      Mesh mesh;
      const Vec3d o = at * size;
      add_triangle(mesh, o, o + Vec3d{size, 0, 0}, o + Vec3d{size, size, 0});
      add_triangle(mesh, o, o + Vec3d{size, size * 1e-9, 0}, o + Vec3d{0.3 * size, 0.7 * size, 0});
      mesh.positions.push_back({std::numeric_limits<double>::quiet_NaN(), 0, size});
      mesh.positions.push_back({0, -std::numeric_limits<double>::infinity(), 0});
      const LatticeFit fit = fit_of(mesh);
      for (const int bits : {1, 10, 21, 24}) {
        const Lattice lattice = fit.lattice(bits);
        const auto points = fit.place(0, lattice);
        for (const Vec3u& p : points) {
          CHECK(std::max(p.x, p.y) <= lattice_max(bits));
          CHECK(p.z == 0);
        }
        CHECK(points[1].x + kMostGrowth >= lattice_max(bits));
      }
    }
  }
}

TEST_CASE("lattice fit: only the nearest point may lie further than the reach") {
  const Mesh mesh = pebble();
  const LatticeFit fit = fit_of(mesh);
  const Lattice lattice = fit.lattice(16);
  const double rounding = rounding_displacement(mesh, lattice);
  const auto largest = [&](const std::vector<Vec3u>& points) {
    double d = 0;
    for (size_t v = 0; v < points.size(); ++v)
      d = std::fmax(d, length(lattice.to_model(points[v]) - mesh.positions[v]));
    return d;
  };
  CHECK(fit.place(0, lattice, 0) == nearest(mesh, lattice));
  CHECK(largest(fit.place(0, lattice, rounding)) <= rounding);
  CHECK(largest(fit.place(0, lattice)) > rounding);
  CHECK(normalise(mesh, 16).max_displacement == largest(fit.place(0, lattice)));
  CHECK(rounding_displacement(mesh, lattice, rounding / 2) > rounding / 2);
}

TEST_CASE("lattice fit: the fewest bits are those that a search through all of them finds") {
  for (const uint32_t seed : {1u, 2u, 3u}) {
    Mesh mesh = scattered(seed);
    const LatticeFit fit = fit_of(mesh);
    for (double allowed = 1e-2; allowed > 1e-9; allowed *= 0.7) {
      std::optional<int> expected;
      for (int bits = kMaxLatticeBits; bits >= kFewestUsefulBits; --bits) {
        const Lattice lattice = fit.lattice(bits);
        mesh.lattice_points = fit.place(0, lattice, allowed);
        if (normalise(mesh, lattice).max_displacement <= allowed) expected = bits;
      }
      CHECK(fit.fewest_bits(allowed) == expected);
    }
  }
}

TEST_CASE("lattice fit: more bits may move a vertex further, and the fewest are found all the same") {
  Mesh mesh;  // 341/1023 = 1/3 is a point of 10 and of 12 bits, not of 11
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1.0 / 3, 1.0 / 3, 0}};
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}};
  mesh.source_primitives = {0, 1};
  CHECK(normalise(mesh, 10).max_displacement < 1e-15);
  CHECK(normalise(mesh, 11).max_displacement > 1e-4);
  CHECK(fit_of(mesh).fewest_bits(1e-12) == 10);
}

TEST_CASE("lattice fit: the fewest bits hold for all meshes on the lattice") {
  const Mesh coarse = scattered(1);
  Mesh exact;
  exact.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  exact.triangles = {{0, 1, 2}};
  exact.source_primitives = {0};
  const Mesh* const both[] = {&exact, &coarse};
  CHECK(fit_of(exact).fewest_bits(1e-6) == kFewestUsefulBits);
  const auto bits = LatticeFit(both).fewest_bits(1e-6);
  REQUIRE(bits);
  CHECK(*bits > kFewestUsefulBits);
}
