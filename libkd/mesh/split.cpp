#include "mesh/split.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "core/box.h"

namespace kd::mesh {
namespace {

/// Takes triangles out of a mesh. What has which number in the part is looked up in tables that serve for all parts, so
/// that many parts together take no longer than one.
class Extractor {
 public:
  explicit Extractor(const Mesh& source)
      : source_(source),
        new_position_(source.positions.size(), kNoIndex),
        new_normal_(source.normals.size(), kNoIndex),
        new_material_(source.materials.size(), kNoIndex) {}

  Mesh take(std::span<const uint32_t> triangles) {
    Mesh part;
    part.triangles.reserve(triangles.size());
    part.source_primitives.reserve(triangles.size());
    for (const uint32_t t : triangles) append(part, t);
    for (const uint32_t t : triangles) forget(t);
    const bool has_normals = std::any_of(part.normal_indices.begin(), part.normal_indices.end(), [](const auto& n) {
      return n[0] != kNoIndex || n[1] != kNoIndex || n[2] != kNoIndex;
    });
    if (!has_normals) part.normal_indices.clear();
    return part;
  }

 private:
  template <class T>
  static uint32_t renumbered(uint32_t old, std::vector<uint32_t>& numbers, const std::vector<T>& from,
                             std::vector<T>& to) {
    if (numbers[old] == kNoIndex) {
      numbers[old] = static_cast<uint32_t>(to.size());
      to.push_back(from[old]);
    }
    return numbers[old];
  }

  void append(Mesh& part, uint32_t t) {
    std::array<uint32_t, 3> corners;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t v = source_.triangles[t][k];
      corners[k] = renumbered(v, new_position_, source_.positions, part.positions);
      const bool is_new = part.lattice_points.size() < part.positions.size();
      if (is_new && !source_.lattice_points.empty()) part.lattice_points.push_back(source_.lattice_points[v]);
    }
    part.triangles.push_back(corners);
    part.source_primitives.push_back(source_.source_primitives[t]);
    if (!source_.normal_indices.empty()) {
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t n = source_.normal_indices[t][k];
        corners[k] = n == kNoIndex ? n : renumbered(n, new_normal_, source_.normals, part.normals);
      }
      part.normal_indices.push_back(corners);
    }
    if (!source_.material_ids.empty()) {
      const uint32_t m = source_.material_ids[t];
      const uint32_t material = renumbered(m, new_material_, source_.materials, part.materials);
      if (material == part.material_names.size()) part.material_names.push_back(source_.material_names[m]);
      part.material_ids.push_back(static_cast<uint16_t>(material));
    }
  }

  void forget(uint32_t t) {
    for (size_t k = 0; k < 3; ++k) {
      new_position_[source_.triangles[t][k]] = kNoIndex;
      if (source_.normal_indices.empty()) continue;
      const uint32_t n = source_.normal_indices[t][k];
      if (n != kNoIndex) new_normal_[n] = kNoIndex;
    }
    if (!source_.material_ids.empty()) new_material_[source_.material_ids[t]] = kNoIndex;
  }

  const Mesh& source_;
  std::vector<uint32_t> new_position_, new_normal_, new_material_;  // kNoIndex: not in the part
};

/// `ids`: per triangle, an index into `names`.
template <class Id>
std::vector<MeshPart> split_by(const Mesh& mesh, const std::vector<Id>& ids, const std::vector<std::string>& names) {
  std::vector<size_t> first(names.size() + 1, 0);  // of each id's triangles in `order`
  for (const Id id : ids) ++first[size_t{id} + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<size_t> next(first.begin(), first.end() - 1);
  std::vector<uint32_t> order(ids.size());
  for (uint32_t t = 0; t < ids.size(); ++t) order[next[ids[t]]++] = t;

  Extractor extractor(mesh);
  std::vector<MeshPart> parts;
  for (size_t id = 0; id < names.size(); ++id) {
    const auto triangles = std::span(order).subspan(first[id], first[id + 1] - first[id]);
    if (!triangles.empty()) parts.push_back({names[id], extractor.take(triangles)});
  }
  return parts;
}

/// In thirds before they are summed: no finite coordinate overflows. What is no number counts as 0, to have a place.
Vec3d centroid(const Mesh& mesh, const std::array<uint32_t, 3>& triangle) {
  Vec3d centre{0, 0, 0};
  for (const uint32_t v : triangle) centre = centre + mesh.positions[v] * (1.0 / 3);
  const auto placed = [](double c) { return std::isnan(c) ? 0 : c; };
  return {placed(centre.x), placed(centre.y), placed(centre.z)};
}

}  // namespace

std::vector<MeshPart> split_by_group(const Mesh& mesh) { return split_by(mesh, mesh.group_ids, mesh.group_names); }

std::vector<MeshPart> split_by_material(const Mesh& mesh) {
  return split_by(mesh, mesh.material_ids, mesh.material_names);
}

std::pair<Mesh, Mesh> split_in_halves(const Mesh& mesh) {
  Box3d centres;
  for (const auto& triangle : mesh.triangles) centres.extend(centroid(mesh, triangle));
  const Vec3d extent = centres.extent();
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;

  struct Place {
    double centre;
    uint32_t triangle;
    auto operator<=>(const Place&) const = default;
  };
  std::vector<Place> places(mesh.triangles.size());
  for (uint32_t t = 0; t < places.size(); ++t) places[t] = {centroid(mesh, mesh.triangles[t])[axis], t};
  const auto middle = places.begin() + static_cast<std::ptrdiff_t>(places.size() / 2);
  std::nth_element(places.begin(), middle, places.end(), [](const Place& a, const Place& b) { return a < b; });

  std::vector<char> is_low(mesh.triangles.size(), 0);
  for (auto p = places.begin(); p != middle; ++p) is_low[p->triangle] = 1;
  std::vector<uint32_t> low, high;
  for (uint32_t t = 0; t < is_low.size(); ++t) (is_low[t] ? low : high).push_back(t);
  Extractor extractor(mesh);
  return {extractor.take(low), extractor.take(high)};
}

Mesh neighbourhood(const Mesh& mesh, uint32_t seed, size_t count) {
  const Vec3d centre = centroid(mesh, mesh.triangles[seed]);
  std::vector<float> distances(mesh.triangles.size());
  for (size_t t = 0; t < distances.size(); ++t) {
    const Vec3d d = centroid(mesh, mesh.triangles[t]) - centre;
    distances[t] = static_cast<float>(std::max({std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)}));
  }
  std::vector<uint32_t> nearest;
  if (count < distances.size()) {
    std::vector<float> order = distances;
    const auto last = order.begin() + static_cast<std::ptrdiff_t>(count);
    std::nth_element(order.begin(), last, order.end());
    const auto is_nearer = [&](float d) { return d < *last; };
    size_t ties = count - static_cast<size_t>(std::count_if(distances.begin(), distances.end(), is_nearer));
    for (uint32_t t = 0; t < distances.size(); ++t) {
      const bool is_tie = distances[t] == *last && ties > 0;
      if (is_tie) --ties;
      if (is_tie || is_nearer(distances[t])) nearest.push_back(t);
    }
  } else {
    nearest.resize(distances.size());
    std::iota(nearest.begin(), nearest.end(), 0u);
  }
  return Extractor(mesh).take(nearest);
}

}  // namespace kd::mesh
