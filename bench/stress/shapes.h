// The meshes of a stress run that are made here, on the lattice.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "mesh/mesh.h"
#include "stress/case_view.h"

namespace kd::stress {

struct Shape {
  std::vector<Vec3u> vertices;  // lattice coordinates
  std::vector<std::array<uint32_t, 3>> triangles;
  CaseTraits traits;
  bool flat = false;  // without extent along z
};

struct ShapeRow {
  std::string_view name;
  std::string_view what;
  Shape (*make)(int bits);
  bool deep;      // under a tree of many small and flat cells, which the usual costs would not pay for
  double weight;  // of its share of the rays
  bool inside;    // what its traits will say, known beforehand
  bool sheets;
};

/// kStressBits.front() is the fewest that the shapes are made for.
constexpr std::array<int, 6> kStressBits{10, 12, 16, 18, 21, 24};

std::span<const ShapeRow> shape_rows();

/// A ball of radius 2 about (148376, 1234, -223423), its coordinates rounded to float32: Embree's watertight test.
mesh::Mesh offset_ball();

}  // namespace kd::stress
