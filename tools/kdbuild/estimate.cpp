#include "kdbuild/estimate.h"

#include <algorithm>

#include "mesh/normalise.h"
#include "mesh/split.h"
#include "nkd/object_file.h"

namespace kd::tools {

namespace {

constexpr uint64_t kLeastTreeBytes = sizeof(uint32_t);  // a triangle: one reference
constexpr uint64_t kMostTreeBytes = 1000;               // a triangle: sponza takes 634 with tests 15 times dearer
constexpr size_t kSamples = 16;
constexpr size_t kSampleSize = 4096;  // triangles
constexpr double kSafety = 1.2;       // over what samples say: sponza, at no price of memory, takes 1.4 times as much

uint64_t tree_bytes(const build::Tree& tree) {
  return tree.nodes.size() * sizeof(Node) + tree.references.size() * sizeof(uint32_t);
}

}  // namespace

SizeEstimate estimated_size(const mesh::Mesh& mesh, int stored_bits) {
  constexpr uint64_t kTriangleBytes = 3 * sizeof(uint32_t);
  std::vector<bool> used(mesh.positions.size());
  for (const auto& triangle : mesh.triangles) {
    for (uint32_t v : triangle) used[v] = true;
  }
  const auto vertices = static_cast<uint64_t>(std::count(used.begin(), used.end(), true));
  const uint64_t triangles = mesh.triangles.size();
  uint64_t a_triangle = triple_bytes(nkd::Geometry::corner_bits_for(vertices));
  if (!mesh.normal_indices.empty()) a_triangle += kTriangleBytes;
  if (!mesh.material_ids.empty()) a_triangle += sizeof(uint16_t);
  if (mesh.source_primitives.back() + 1 != triangles) a_triangle += sizeof(uint32_t);
  const uint64_t rest = triangles * a_triangle + vertices * triple_bytes(stored_bits) +
                        mesh.normals.size() * sizeof(Vec3f) + mesh.materials.size() * sizeof(Material);
  return {rest, triangles * kLeastTreeBytes, triangles * kMostTreeBytes};
}

Result<uint64_t> sampled_tree_bytes(const mesh::Mesh& mesh, const Lattice& lattice,
                                    const build::BuildSettings& settings, const Progress& progress) {
  const size_t triangles = mesh.triangles.size();
  uint64_t bytes = 0, sampled = 0;
  for (size_t i = 0; i < kSamples; ++i) {
    const auto seed = static_cast<uint32_t>(triangles * (2 * i + 1) / (2 * kSamples));
    const mesh::Mesh sample = mesh::neighbourhood(mesh, seed, kSampleSize);
    const mesh::LatticeMesh on_lattice = mesh::normalise(sample, lattice);
    if (on_lattice.triangles.empty()) continue;
    // In the box of the whole a byte a triangle of the sample is as dear as one of the whole if it is so much cheaper.
    build::BuildSettings cheaper = settings;
    cheaper.costs.byte_price *= static_cast<double>(on_lattice.triangles.size()) / static_cast<double>(triangles);
    const auto tree = build::build_tree(on_lattice.lattice, on_lattice.vertices, on_lattice.triangles, cheaper,
                                        [&](double) { return keep_going(progress, 0); });
    if (!tree) return tree.error();
    bytes += tree_bytes(*tree);
    sampled += on_lattice.triangles.size();
  }
  if (sampled == 0) return uint64_t{0};
  return static_cast<uint64_t>(kSafety * static_cast<double>(bytes) / static_cast<double>(sampled) *
                               static_cast<double>(triangles));
}

}  // namespace kd::tools
