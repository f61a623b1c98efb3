// Choosing a lattice from the error that it may make.
#include <doctest/doctest.h>

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
