// A mesh of random triangles.
#pragma once

#include "mesh/mesh.h"

namespace kd::test {

/// Triangles with corners all over the unit cube, which they touch on every side; some of them slivers.
inline mesh::Mesh scattered(uint32_t seed) {
  mesh::Mesh mesh;
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

}  // namespace kd::test
