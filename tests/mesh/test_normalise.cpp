// The form without a lattice.
#include <doctest/doctest.h>

#include <bit>
#include <cmath>

#include "mesh/lattice_fit.h"
#include "mesh/normalise.h"
#include "mesh/scattered.h"

using namespace kd;
using namespace kd::mesh;

TEST_CASE("normalise: float32 vertices are the nearest floats, and displacement is what they are off by") {
  Mesh mesh = test::scattered(4);  // in the box [0, 1]^3, on a lattice of 24 bits until it is squared
  for (Vec3d& p : mesh.positions) p = p * p;
  const Lattice tight{bounds(mesh).lo, bounds(mesh).extent(), 24};
  const LatticeMesh floats = normalise(mesh, tight, VertexForm::float32);
  const LatticeMesh rounded = normalise(mesh, tight);  // its vertices have not been placed
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
  const Lattice tight{bounds(mesh).lo, bounds(mesh).extent(), 24};
  const LatticeMesh floats = normalise(mesh, tight, VertexForm::float32);
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
