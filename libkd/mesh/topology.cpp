#include "mesh/topology.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "mesh/weld.h"

namespace kd::mesh {
namespace {

/// Disjoint sets of vertices, by path halving.
class Sets {
 public:
  explicit Sets(size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0u); }
  uint32_t root(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<uint32_t> parent_;
};

struct EdgeUse {
  uint64_t ends;  // smaller vertex << 32 | greater vertex
  bool forward;   // from the smaller to the greater
};

void count_edges(std::vector<EdgeUse>& uses, Topology& result) {
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) { return a.ends < b.ends; });
  for (size_t first = 0, end = 0; first < uses.size(); first = end) {
    while (end < uses.size() && uses[end].ends == uses[first].ends) ++end;
    ++result.edges;
    result.boundary_edges += end - first == 1;
    result.non_manifold_edges += end - first > 2;
    result.inconsistent_edges += end - first == 2 && uses[first].forward == uses[first + 1].forward;
  }
  result.closed = result.edges > 0 && result.boundary_edges == 0 && result.non_manifold_edges == 0;
}

}  // namespace

Topology topology(const Mesh& mesh) {
  const std::vector<uint32_t> place = weld(mesh.positions);
  std::vector<char> used(place.size(), 0);
  Sets sets(place.size());
  std::vector<EdgeUse> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    const std::array<uint32_t, 3> v{place[t[0]], place[t[1]], place[t[2]]};
    for (const uint32_t i : v) used[i] = 1;
    sets.join(v[0], v[1]);
    sets.join(v[1], v[2]);
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t from = v[k], to = v[(k + 1) % 3];
      uses.push_back({uint64_t{std::min(from, to)} << 32 | std::max(from, to), from < to});
    }
  }
  Topology result;
  for (uint32_t i = 0; i < used.size(); ++i) {
    result.vertices += used[i] != 0;
    result.components += used[i] != 0 && sets.root(i) == i;
  }
  count_edges(uses, result);
  return result;
}

}  // namespace kd::mesh
