// The meshes that the suite builds trees over.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "../core/shapes.h"
#include "mesh/clean.h"
#include "mesh/normalise.h"
#include "mesh/read_mesh.h"

namespace kd::test {

struct Subject {
  std::string name;
  Shape shape;
  Lattice lattice;
};

inline Subject subject(std::string name, Shape shape, int bits) {
  return {std::move(name), std::move(shape), cube_lattice(bits)};
}

inline std::vector<Subject> small_subjects(int bits) {
  const uint32_t top = lattice_max(bits);
  std::vector<Subject> all;
  all.push_back(subject("large soup", soup_shape(bits, 150, Soup::large, 1), bits));
  all.push_back(subject("small soup", soup_shape(bits, 600, Soup::small, 2), bits));
  all.push_back(subject("needles", soup_shape(bits, 250, Soup::needles, 3), bits));
  all.push_back(subject("mixed soup", soup_shape(bits, 300, Soup::mixed, 4), bits));
  all.push_back(subject("rooms", rooms_shape(bits, 4, 5), bits));
  all.push_back(subject("boxes", stacked_boxes_shape(bits, 4), bits));
  all.push_back(subject("sphere", sphere_shape(bits, 2), bits));
  all.push_back(subject("box", box_shape({0, 0, 0}, {top, top, top}), bits));
  return all;
}

/// A mesh of the shared data on the lattice; nothing where the data is not there.
inline std::optional<Subject> shared_mesh(const std::string& name, int bits) {
  const std::string path = std::string(KD_SOURCE_DIR) + "/../shared/data/" + name;
  if (!std::filesystem::exists(path)) return std::nullopt;
  auto mesh = mesh::read_mesh(path, {});
  if (!mesh) return std::nullopt;
  mesh::clean(*mesh);
  mesh::LatticeMesh m = mesh::normalise(*mesh, bits);
  return Subject{name, {std::move(m.vertices), std::move(m.triangles)}, m.lattice};
}

inline build::Tree tree_of(const Subject& s, const build::BuildSettings& settings = {}) {
  return *build::build_tree(s.lattice, s.shape.vertices, s.shape.triangles, settings);
}

}  // namespace kd::test
