// The lattice and its error: choosing the one from the other, and the form without a lattice.
#include <doctest/doctest.h>

#include <bit>
#include <cmath>

#include "mesh/normalise.h"

using namespace kd;
using namespace kd::mesh;

namespace {

/// Triangles with corners all over the unit cube, which they touch on every side; some of them slivers.
Mesh scattered(uint32_t seed) {
  Mesh mesh;
  const auto next = [&seed] {
    seed = seed * 1664525 + 1013904223;
    return static_cast<double>(seed >> 8) / 0xffffff;
  };
  mesh.positions = {{0, 0, 0}, {1, 1, 1}};
  for (uint32_t i = 0; i < 200; ++i) {
    mesh.positions.push_back({next(), next(), next()});
    mesh.triangles.push_back({i, i + 1, i + 2});
    mesh.source_primitives.push_back(i);
  }
  for (uint32_t i = 0; i < 20; ++i) {  // these collapse on a coarse lattice
    const Vec3d p{next(), next(), next()};
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (const Vec3d& d : {Vec3d{0, 0, 0}, Vec3d{1e-4, 0, 0}, Vec3d{0, 1e-4, 0}}) mesh.positions.push_back(p * 0.9 + d);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.source_primitives.push_back(200 + i);
  }
  return mesh;
}

}  // namespace

TEST_CASE("normalise: the displacement alone is the one that normalising gives") {
  const Mesh mesh = scattered(1);
  const Box3d box = bounds(mesh);
  for (int bits = kMinLatticeBits; bits <= kMaxLatticeBits; ++bits) {
    const LatticeMesh normalised = normalise(mesh, bits);
    const Lattice lattice{box.lo, box.extent(), bits};
    CHECK(max_displacement(mesh, lattice) == normalised.max_displacement);
    CHECK(max_displacement(mesh, lattice, normalised.max_displacement / 2) > normalised.max_displacement / 2);
  }
}

TEST_CASE("normalise: the fewest bits are those that a search through all of them finds") {
  for (const uint32_t seed : {1u, 2u, 3u}) {
    const Mesh mesh = scattered(seed);
    const Mesh* const meshes[] = {&mesh};
    for (double allowed = 1e-2; allowed > 1e-9; allowed *= 0.7) {
      std::optional<int> expected;
      for (int bits = kMaxLatticeBits; bits >= kFewestUsefulBits; --bits) {
        if (normalise(mesh, bits).max_displacement <= allowed) expected = bits;
      }
      CHECK(fewest_bits(meshes, bounds(mesh), allowed) == expected);
    }
  }
}

TEST_CASE("normalise: more bits may move a vertex further, and the fewest are found all the same") {
  Mesh mesh;  // 341/1023 = 1/3 is a point of 10 and of 12 bits, not of 11
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1.0 / 3, 1.0 / 3, 0}};
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}};
  mesh.source_primitives = {0, 1};
  const Mesh* const meshes[] = {&mesh};
  CHECK(normalise(mesh, 10).max_displacement < 1e-15);
  CHECK(normalise(mesh, 11).max_displacement > 1e-4);
  CHECK(fewest_bits(meshes, bounds(mesh), 1e-12) == 10);
}

TEST_CASE("normalise: the fewest bits hold for all meshes on the lattice") {
  const Mesh coarse = scattered(1);
  Mesh exact;
  exact.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  exact.triangles = {{0, 1, 2}};
  exact.source_primitives = {0};
  const Mesh* const both[] = {&exact, &coarse};
  const Mesh* const one[] = {&exact};
  const Box3d box = bounds(coarse);
  CHECK(fewest_bits(one, box, 1e-6) == kFewestUsefulBits);
  const auto bits = fewest_bits(both, box, 1e-6);
  REQUIRE(bits);
  CHECK(*bits > kFewestUsefulBits);
  CHECK(normalise(coarse, *bits).max_displacement <= 1e-6);
}

TEST_CASE("normalise: float32 vertices are the nearest floats, and displacement is what they are off by") {
  Mesh mesh = scattered(4);  // in the box [0, 1]^3, on a lattice of 24 bits until it is squared
  for (Vec3d& p : mesh.positions) p = p * p;
  const LatticeMesh floats = normalise(mesh, 24, bounds(mesh), VertexForm::float32);
  const LatticeMesh rounded = normalise(mesh, 24);
  REQUIRE(floats.float_vertices.size() == floats.vertices.size());
  CHECK(floats.triangles.size() == rounded.triangles.size());
  CHECK(floats.collapsed_triangles == rounded.collapsed_triangles);
  CHECK(floats.kept == rounded.kept);
  double largest = 0;
  int off_lattice = 0;
  for (size_t i = 0; i < floats.triangles.size(); ++i) {
    for (size_t k = 0; k < 3; ++k) {
      const Vec3d p = mesh.positions[mesh.triangles[floats.kept[i]][k]];
      const Vec3f f = floats.float_vertices[floats.triangles[i][k]];
      const Vec3u q = floats.vertices[floats.triangles[i][k]];
      long double squared = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const long double wanted = static_cast<long double>(p[axis]) * 16777215;
        const auto off = [&](float v) { return std::fabs(v - wanted); };
        // The division by the step is rounded in double: that much may break a tie the other way.
        REQUIRE(off(f[axis]) <= off(std::nextafter(f[axis], 0.0f)) + 1e-8L);
        REQUIRE(off(f[axis]) <= off(std::nextafter(f[axis], 3e7f)) + 1e-8L);
        REQUIRE(std::fabs(f[axis] - static_cast<float>(q[axis])) <= 0.5f);
        const long double moved = f[axis] / 16777215.0L - p[axis];
        squared += moved * moved;
        off_lattice += f[axis] != static_cast<float>(q[axis]);
      }
      largest = std::fmax(largest, static_cast<double>(std::sqrt(squared)));
    }
  }
  CHECK(off_lattice > 100);
  CHECK(floats.max_displacement == doctest::Approx(largest).epsilon(1e-6));
  CHECK(floats.max_displacement < rounded.max_displacement);
  CHECK(floats.rms_displacement < rounded.rms_displacement);
  CHECK(floats.rms_displacement > 0);
}

TEST_CASE("normalise: float32 vertices are one where they are stored alike, whatever the lattice says") {
  const double step = 1.0 / 16777215;
  Mesh mesh;
  mesh.positions = {{0, 0, 0},
                    {1, 1, 1},
                    {0, 1, 0},
                    {1, 0, 0},
                    {0.75, 0.5, 0},
                    {0.1 * step, 0, 0},      // a float of its own, the lattice point of 0
                    {0.75 + 1e-12, 0.5, 0},  // the float of 4
                    {-0.0, 0, -0.0}};        // the floats of 0
  mesh.triangles = {{0, 1, 2}, {5, 1, 3}, {4, 1, 2}, {6, 1, 3}, {7, 3, 1}, {0, 5, 2}};
  mesh.source_primitives = {0, 1, 2, 3, 4, 5};
  const LatticeMesh floats = normalise(mesh, 24, bounds(mesh), VertexForm::float32);
  const auto& t = floats.triangles;
  REQUIRE(t.size() == 5);
  CHECK(t[1][0] != t[0][0]);
  CHECK(floats.vertices[t[1][0]] == floats.vertices[t[0][0]]);
  CHECK(t[3][0] == t[2][0]);
  CHECK(t[4][0] == t[0][0]);
  CHECK(floats.welded_vertices == 2);
  CHECK(floats.collapsed_triangles == 1);  // 0 5 2: a line on the lattice
  CHECK(floats.first_collapsed == 5);
  for (const Vec3f& v : floats.float_vertices) {
    for (int axis = 0; axis < 3; ++axis) CHECK_FALSE(std::signbit(v[axis]));
  }
}
