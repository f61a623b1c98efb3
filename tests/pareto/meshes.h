// Meshes of data/ for these tests, and as lists of corners.
#pragma once

#include <doctest/doctest.h>

#include "corners.h"
#include "mesh/read_mesh.h"
#include "support/workshop.h"

namespace kd::test {

inline mesh::Mesh data_mesh(const char* name) {
  auto mesh = mesh::read_mesh((source_root() / "data" / name).string(), {});
  REQUIRE(mesh);
  return std::move(*mesh);
}

inline std::vector<bench::Corners> corners_of(const mesh::Mesh& mesh) {
  std::vector<bench::Corners> out;
  for (const auto& t : mesh.triangles)
    out.push_back({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
  return out;
}

}  // namespace kd::test
