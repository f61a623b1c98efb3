// Objects in memory that a test can spoil, and files of them.
#pragma once

#include <bit>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../core/shapes.h"
#include "nkd/object_file.h"
#include "nkd/validate.h"
#include "nkd/write.h"
#include "support/temp_folder.h"

namespace kd::test {

inline std::string read_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// All that a .nkd holds, owned; sound as made, with every section.
struct Contents {
  nkd::Summary summary;
  std::vector<Node> nodes;
  std::vector<uint32_t> references;
  std::vector<uint8_t> triangles, vertices;
  VertexForm form = VertexForm::lattice;
  std::vector<uint32_t> source_primitives, normal_indices;
  std::vector<Vec3f> normals;
  std::vector<Material> materials;
  std::vector<uint16_t> material_ids;

  Contents(const Shape& shape, int bits, bool attributes = true) {
    summary.lattice = cube_lattice(bits);
    summary.max_displacement = 0.5;
    summary.rms_displacement = 0.25;
    summary.provenance = {"shape.ply", 0x0123456789abcdefull, "--bits " + std::to_string(bits), "test 1"};
    build::Tree tree = *build::build_tree(summary.lattice, shape.vertices, shape.triangles, {});
    nodes = std::move(tree.nodes);
    references = std::move(tree.references);
    triangles = pack_triples(shape.triangles, nkd::Geometry::corner_bits_for(shape.vertices.size()));
    vertices = pack_triples(shape.vertices, bits);
    count_tree();
    if (!attributes) return;
    for (uint32_t i = 0; i < shape.triangles.size(); ++i) source_primitives.push_back(3 * i + 1);
    normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
    for (uint32_t i = 0; i < 3 * shape.triangles.size(); ++i)
      normal_indices.push_back(i % 4 == 3 ? 0xffffffffu : i % 4);
    materials = {Material{}, Material{{0, 0, 0}, {0.5f, 0, 1}, {1, 1, 1}, 30}};
    summary.material_names = {"first", "second"};
    for (uint32_t i = 0; i < shape.triangles.size(); ++i) material_ids.push_back(static_cast<uint16_t>(i % 2));
  }

  void count_tree() { summary.tree = tree_statistics(nodes, summary.lattice); }

  /// Stores the vertices in float32, up to a quarter of a step beside their lattice points. Of 24 bits.
  void store_floats(uint64_t seed) {
    Random random(seed);
    std::vector<Vec3u> floats = unpacked(vertices, kMaxLatticeBits);
    for (Vec3u& vertex : floats) {
      for (int axis = 0; axis < 3; ++axis) {
        const uint32_t at = vertex[axis];
        const bool at_end = at == 0 || at == lattice_max(kMaxLatticeBits);
        const auto moved = static_cast<float>(at + (at_end ? 0 : random.real(-0.24, 0.24)));
        vertex.set(axis, std::bit_cast<uint32_t>(moved));
      }
    }
    form = VertexForm::float32;
    vertices = pack_triples(floats, 32);
  }

  /// Puts another triple in the place of number i.
  static void replace(std::vector<uint8_t>& section, int bits, size_t i, Vec3u triple) {
    std::vector<Vec3u> triples = unpacked(section, bits);
    triples[i] = triple;
    section = pack_triples(triples, bits);
  }

  static std::vector<Vec3u> unpacked(const std::vector<uint8_t>& section, int bits) {
    std::vector<Vec3u> triples(triple_count(section.size(), bits));
    for (size_t i = 0; i < triples.size(); ++i) triples[i] = PackedTriples{section.data(), bits}[i];
    return triples;
  }

  nkd::Geometry geometry() const { return {nodes, references, triangles, vertices, summary.lattice.bits, form}; }

  std::string write(const std::string& path) const {
    const auto written = nkd::write_object(path, summary, geometry(),
                                           {source_primitives, normals, normal_indices, materials, material_ids});
    return written ? path : "";
  }
};

/// The bytes of a stored vector's element 0, in a file that holds the section.
template <class T>
char* bytes_of(std::string& file, const std::vector<T>& section) {
  const std::string wanted(reinterpret_cast<const char*>(section.data()), section.size() * sizeof(T));
  const size_t at = file.find(wanted);
  return at == std::string::npos ? nullptr : file.data() + at;
}

/// What opening or deep validation finds first, as "NKD307"; "sound" if nothing.
inline std::string verdict(const std::string& path) {
  const auto file = nkd::ObjectFile::open(path);
  if (!file) return file.error().what.substr(0, 6);
  const auto findings = nkd::validate(*file);
  return findings.empty() ? "sound" : findings.front().line().substr(0, 6);
}

}  // namespace kd::test
