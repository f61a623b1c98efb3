#include "mesh/normalise.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace kd::mesh {

namespace {

double displacement(const Lattice& lattice, Vec3d p_model, Vec3u q) { return length(lattice.to_model(q) - p_model); }

/// Exact: coordinates have 24 bits at most, so a cross product's components have 51.
bool has_area(Vec3u a, Vec3u b, Vec3u c) {
  const auto p = vec_cast<int64_t>(b) - vec_cast<int64_t>(a);
  const auto q = vec_cast<int64_t>(c) - vec_cast<int64_t>(a);
  return !(cross(p, q) == Vec3<int64_t>{0, 0, 0});
}

/// Lattice points by first use.
class VertexTable {
 public:
  explicit VertexTable(size_t expected) { index_of_.reserve(expected); }

  uint32_t index(Vec3u q, std::vector<Vec3u>& vertices) {
    const Key key{uint64_t{q.x} << 32 | q.y, q.z};
    const auto [entry, fresh] = index_of_.try_emplace(key, static_cast<uint32_t>(vertices.size()));
    if (fresh) vertices.push_back(q);
    return entry->second;
  }

 private:
  struct Key {
    uint64_t xy;
    uint32_t z;
    bool operator==(const Key&) const = default;
  };
  struct Hash {
    size_t operator()(const Key& k) const {
      const uint64_t h = (k.xy ^ k.xy >> 29) * 0x9e3779b97f4a7c15ull + k.z * 0xc2b2ae3d27d4eb4full;
      return h ^ h >> 32;
    }
  };
  std::unordered_map<Key, uint32_t, Hash> index_of_;
};

}  // namespace

Box3d bounds(const Mesh& mesh) {
  Box3d box_model;
  for (const auto& triangle : mesh.triangles) {
    for (uint32_t v : triangle) box_model.extend(mesh.positions[v]);
  }
  return box_model;
}

LatticeMesh normalise(const Mesh& mesh, int bits) { return normalise(mesh, bits, bounds(mesh)); }

LatticeMesh normalise(const Mesh& mesh, int bits, const Box3d& box_model) {
  LatticeMesh out;
  out.lattice = {box_model.lo, box_model.extent(), bits};
  out.triangles.reserve(mesh.triangles.size());
  out.kept.reserve(mesh.triangles.size());

  std::vector<uint32_t> new_index(mesh.positions.size(), kNoIndex);
  VertexTable table(mesh.positions.size());
  double sum_of_squares = 0;
  uint64_t used = 0;
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    std::array<Vec3u, 3> corners;
    for (size_t k = 0; k < 3; ++k) corners[k] = out.lattice.to_lattice(mesh.positions[mesh.triangles[i][k]]);
    if (!has_area(corners[0], corners[1], corners[2])) {
      if (out.collapsed_triangles++ == 0) out.first_collapsed = mesh.source_primitives[i];
      for (size_t k = 0; k < 3; ++k) {
        const double moved = displacement(out.lattice, mesh.positions[mesh.triangles[i][k]], corners[k]);
        out.max_displacement = std::fmax(out.max_displacement, moved);
      }
      continue;
    }
    std::array<uint32_t, 3> triangle;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t v = mesh.triangles[i][k];
      if (new_index[v] == kNoIndex) {
        const size_t before = out.vertices.size();
        new_index[v] = table.index(corners[k], out.vertices);
        if (out.vertices.size() == before) ++out.welded_vertices;
        const double moved = displacement(out.lattice, mesh.positions[v], corners[k]);
        out.max_displacement = std::fmax(out.max_displacement, moved);
        sum_of_squares += moved * moved;
        ++used;
      }
      triangle[k] = new_index[v];
    }
    out.triangles.push_back(triangle);
    out.kept.push_back(i);
  }
  out.rms_displacement = used > 0 ? std::sqrt(sum_of_squares / static_cast<double>(used)) : 0;
  return out;
}

double max_displacement(const Mesh& mesh, const Lattice& lattice, double enough) {
  double largest = 0;
  for (const auto& triangle : mesh.triangles) {
    for (uint32_t v : triangle) {
      const Vec3d p_model = mesh.positions[v];
      largest = std::fmax(largest, displacement(lattice, p_model, lattice.to_lattice(p_model)));
    }
    if (largest > enough) break;
  }
  return largest;
}

std::optional<int> fewest_bits(std::span<const Mesh* const> meshes, const Box3d& box, double allowed) {
  for (int bits = kFewestUsefulBits; bits <= kMaxLatticeBits; ++bits) {
    const Lattice lattice{box.lo, box.extent(), bits};
    const auto keeps = [&](const Mesh* mesh) { return max_displacement(*mesh, lattice, allowed) <= allowed; };
    if (std::all_of(meshes.begin(), meshes.end(), keeps)) return bits;
  }
  return std::nullopt;
}

}  // namespace kd::mesh
