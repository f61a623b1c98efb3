#include "kdbuild/explain.h"

#include <algorithm>
#include <bit>

#include <fmt/format.h>

#include "core/sah.h"
#include "core/tree_statistics.h"

namespace kd::tools {

namespace {

constexpr uint32_t kSingleBins = 9;  // 0 to 8

/// Calls visit(triangle) for every triangle of a leaf: the one place here that knows how a leaf names them.
template <class Visit>
void for_each_reference(Node leaf, std::span<const uint32_t> references, const Visit& visit) {
  for (uint32_t triangle : references.subspan(first_reference(leaf), reference_count(leaf))) visit(triangle);
}

/// The bin of a number; the histogram grows to have it.
Bin& bin_of(uint32_t number, std::vector<Bin>& bins) {
  const auto doublings = static_cast<uint32_t>(number > 8 ? std::bit_width(number - 1) - 4 : 0);
  const uint32_t index = number > 8 ? kSingleBins + doublings : number;
  while (bins.size() <= index) {
    const auto next = static_cast<uint32_t>(bins.size());
    if (next < kSingleBins) {
      bins.push_back({next, next});
    } else {
      const uint64_t lowest = uint64_t{8} << (next - kSingleBins);
      bins.push_back(
          {static_cast<uint32_t>(lowest + 1), static_cast<uint32_t>(std::min<uint64_t>(2 * lowest, 0xffffffffu))});
    }
  }
  return bins[index];
}

/// Volume of a cell as a share of the box; an axis on which the box is flat counts for nothing.
double volume_share(const Box3u& cell, const Box3u& cube) {
  double share = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const uint32_t whole = cube.hi[axis] - cube.lo[axis];
    if (whole > 0) share *= static_cast<double>(cell.hi[axis] - cell.lo[axis]) / whole;
  }
  return share;
}

void count_triangles(std::vector<uint32_t> times, Explanation& out) {
  for (uint32_t n : times) ++bin_of(n, out.triangle_references).count;
  std::sort(times.begin(), times.end());
  const auto quantile = [&](size_t percent) { return times[(times.size() * percent + 99) / 100 - 1]; };
  out.median_references = quantile(50);
  out.references_95 = quantile(95);
  out.most_references = times.back();
}

}  // namespace

Explanation explain(std::span<const Node> nodes, std::span<const uint32_t> references, size_t triangles,
                    const Lattice& lattice) {
  Explanation out;
  out.triangles = triangles;
  std::vector<uint32_t> times(triangles);
  const Vec3d step = lattice.proportions();
  const double root_area = half_area(vec_cast<double>(lattice.cube().extent()) * step);
  for_each_node(nodes, lattice, [&](uint32_t, Node node, const Box3u& cell, uint32_t depth) {
    const double visits = root_area > 0 ? half_area(vec_cast<double>(cell.extent()) * step) / root_area : 1;
    if (out.levels.size() <= depth) out.levels.resize(depth + 1);
    Level& level = out.levels[depth];
    if (!is_leaf(node)) {
      ++level.inner_nodes;
      level.traversal_cost += visits;
      return;
    }
    const uint32_t count = reference_count(node);
    ++level.leaves;
    level.intersection_cost += kIntersectionCost * count * visits;
    out.references += count;
    out.leaf_visits += visits;
    Bin& bin = bin_of(count, out.leaf_sizes);
    ++bin.count;
    bin.visits += visits;
    if (count == 0) out.empty_volume += volume_share(cell, lattice.cube());
    for_each_reference(node, references, [&](uint32_t triangle) { ++times[triangle]; });
  });
  for (const Level& level : out.levels) {
    out.inner_nodes += level.inner_nodes;
    out.leaves += level.leaves;
    out.traversal_cost += level.traversal_cost;
    out.intersection_cost += level.intersection_cost;
  }
  out.empty_leaves = out.leaf_sizes[0].count;
  out.empty_visits = out.leaf_sizes[0].visits;
  count_triangles(std::move(times), out);
  return out;
}

std::string bin_name(const Bin& bin) {
  return bin.lowest == bin.highest ? fmt::format("{}", bin.lowest) : fmt::format("{}-{}", bin.lowest, bin.highest);
}

}  // namespace kd::tools
