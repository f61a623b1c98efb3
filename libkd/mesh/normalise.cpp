#include "mesh/normalise.h"

#include <bit>
#include <cmath>
#include <span>
#include <unordered_map>

#include "mesh/lattice_fit.h"

namespace kd::mesh {

namespace {

/// A vertex as it is stored, and as the tree sees it. What is stored is exact in float32 in either form, and kept so:
/// of doubles that were rounded to float32 and back, g++ 12's vectoriser leaves out the rounding.
struct Corner {
  Vec3f stored;  // lattice space
  Vec3u point;
  Vec3u key;  // equal for vertices that are stored alike
};

Corner lattice_corner(Vec3u point) { return {vec_cast<float>(point), point, point}; }

Corner float_corner(const Lattice& lattice, Vec3d p_model) {
  const auto bits = [](float v) { return std::bit_cast<uint32_t>(v); };
  // Adding 0 turns -0, which a coordinate of -0 in a box from +0 gives, into 0.
  const Vec3f f = vec_cast<float>(lattice.to_lattice_space(p_model) + Vec3d{0, 0, 0});
  return {
      f, vec_cast<uint32_t>(Vec3f{std::rint(f.x), std::rint(f.y), std::rint(f.z)}), {bits(f.x), bits(f.y), bits(f.z)}};
}

/// Exact: coordinates have 24 bits at most, so a cross product's components have 51.
bool has_area(Vec3u a, Vec3u b, Vec3u c) {
  const auto p = vec_cast<int64_t>(b) - vec_cast<int64_t>(a);
  const auto q = vec_cast<int64_t>(c) - vec_cast<int64_t>(a);
  return !(cross(p, q) == Vec3<int64_t>{0, 0, 0});
}

/// Vertices by first use.
class VertexTable {
 public:
  explicit VertexTable(size_t expected) { index_of_.reserve(expected); }

  /// The index of the vertices that are stored alike, and whether this is the first of them.
  std::pair<uint32_t, bool> index(Vec3u key) {
    const auto [entry, fresh] =
        index_of_.try_emplace({uint64_t{key.x} << 32 | key.y, key.z}, static_cast<uint32_t>(index_of_.size()));
    return {entry->second, fresh};
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

/// `points`: per position, or empty.
LatticeMesh normalise_placed(const Mesh& mesh, std::span<const Vec3u> points, const Lattice& lattice, VertexForm form) {
  LatticeMesh out;
  out.lattice = lattice;
  out.triangles.reserve(mesh.triangles.size());
  out.kept.reserve(mesh.triangles.size());

  const auto corner_of = [&](uint32_t v) {
    if (form == VertexForm::float32) return float_corner(lattice, mesh.positions[v]);
    return lattice_corner(points.empty() ? lattice.to_lattice(mesh.positions[v]) : points[v]);
  };
  std::vector<uint32_t> new_index(mesh.positions.size(), kNoIndex);
  VertexTable table(mesh.positions.size());
  const auto moved = [&](const Corner& corner, Vec3d p_model) {
    const double distance = length(out.lattice.to_model_space(vec_cast<double>(corner.stored)) - p_model);
    out.max_displacement = std::fmax(out.max_displacement, distance);
    return distance;
  };
  double sum_of_squares = 0;
  uint64_t used = 0;
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    std::array<Corner, 3> corners;
    for (size_t k = 0; k < 3; ++k) corners[k] = corner_of(mesh.triangles[i][k]);
    if (!has_area(corners[0].point, corners[1].point, corners[2].point)) {
      if (out.collapsed_triangles++ == 0) out.first_collapsed = mesh.source_primitives[i];
      for (size_t k = 0; k < 3; ++k) moved(corners[k], mesh.positions[mesh.triangles[i][k]]);
      continue;
    }
    std::array<uint32_t, 3> triangle;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t v = mesh.triangles[i][k];
      if (new_index[v] == kNoIndex) {
        const auto [index, fresh] = table.index(corners[k].key);
        new_index[v] = index;
        if (fresh) {
          out.vertices.push_back(corners[k].point);
          if (form == VertexForm::float32) out.float_vertices.push_back(corners[k].stored);
        }
        out.welded_vertices += !fresh;
        const double distance = moved(corners[k], mesh.positions[v]);
        sum_of_squares += distance * distance;
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

}  // namespace

LatticeMesh normalise(const Mesh& mesh, int bits) {
  const Mesh* const meshes[] = {&mesh};
  const LatticeFit fit(meshes);
  const Lattice lattice = fit.lattice(bits);
  return normalise_placed(mesh, fit.place(0, lattice), lattice, VertexForm::lattice);
}

LatticeMesh normalise(const Mesh& mesh, const Lattice& lattice, VertexForm form) {
  return normalise_placed(mesh, mesh.lattice_points, lattice, form);
}

}  // namespace kd::mesh
