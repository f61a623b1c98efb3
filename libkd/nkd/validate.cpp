#include "nkd/validate.h"

#include <algorithm>
#include <map>
#include <mutex>

#include <fmt/format.h>

#include "nkd/overlap.h"
#include "sys/parallel.h"

namespace kd::nkd {

namespace {

using Corners = std::array<Vec3u, 3>;

/// Collects findings from any thread: of each issue the one with the lowest index, so that the report is always the
/// same.
class Findings {
 public:
  void add(Issue issue, uint32_t index, std::string detail) {
    const std::lock_guard lock(mutex_);
    const auto [entry, fresh] = found_.try_emplace(issue, index, detail);
    if (!fresh && index < entry->second.first) entry->second = {index, std::move(detail)};
  }
  std::vector<Finding> list() const {
    std::vector<Finding> all;
    for (const auto& [issue, where] : found_) all.push_back({issue, where.second});
    return all;
  }

 private:
  std::mutex mutex_;
  std::map<Issue, std::pair<uint32_t, std::string>> found_;
};

class TreeCheck {
 public:
  TreeCheck(const ObjectFile& file, Findings& findings)
      : lattice_(file.summary().lattice), geometry_(file.geometry()), findings_(findings) {}

  bool planes_inside() const;
  void leaves() const;
  void coverage() const;

 private:
  Corners corners(uint32_t triangle) const {
    const PackedTriangles packed = geometry_.packed();
    const Vec3u c = packed.corners[triangle];
    return {packed.lattice_point(c.x), packed.lattice_point(c.y), packed.lattice_point(c.z)};
  }
  std::span<const uint32_t> references(Node leaf) const {
    return geometry_.references.subspan(first_reference(leaf), reference_count(leaf));
  }
  bool covered(uint32_t triangle, const Corners& c, uint32_t index, const Box3u& cell) const;

  const Lattice& lattice_;
  const Geometry& geometry_;
  Findings& findings_;
};

bool TreeCheck::planes_inside() const {
  bool inside = true;
  for_each_node(geometry_.nodes, lattice_, [&](uint32_t index, Node node, const Box3u& cell, uint32_t) {
    if (is_leaf(node)) return;
    const int axis = split_axis(node);
    const auto plane = static_cast<uint32_t>(split_plane(node));
    if (plane >= cell.lo[axis] && plane <= cell.hi[axis]) return;
    inside = false;
    findings_.add(Issue::plane_outside, index, fmt::format("node {}", index));
  });
  return inside;
}

Box3u widened(const Box3u& b) {
  const auto down = [](uint32_t v) { return v > 0 ? v - 1 : 0; };
  return {{down(b.lo.x), down(b.lo.y), down(b.lo.z)}, {b.hi.x + 1, b.hi.y + 1, b.hi.z + 1}};
}

void TreeCheck::leaves() const {
  for_each_node(geometry_.nodes, lattice_, [&](uint32_t index, Node node, const Box3u& cell, uint32_t) {
    if (!is_leaf(node)) return;
    const auto refs = references(node);
    if (std::adjacent_find(refs.begin(), refs.end(), std::greater_equal<>()) != refs.end()) {
      findings_.add(Issue::unordered_leaf, index, fmt::format("node {}", index));
    }
    for (uint32_t triangle : refs) {
      if (!triangle_meets_box(corners(triangle), widened(cell), false)) {
        findings_.add(Issue::foreign_reference, index, fmt::format("node {}, triangle {}", index, triangle));
      }
    }
  });
}

/// Whether every leaf below `index` through whose cell the triangle passes refers to it. A triangle that lies in a
/// split plane belongs to one side of it, whichever.
bool TreeCheck::covered(uint32_t triangle, const Corners& c, uint32_t index, const Box3u& cell) const {
  Box3u met = cell;
  for (int axis = 0; axis < 3; ++axis) {
    const uint32_t at = c[0][axis];
    if (at != c[1][axis] || at != c[2][axis]) {
      if (cell.lo[axis] == cell.hi[axis]) return true;
      continue;
    }
    if (at < cell.lo[axis] || at > cell.hi[axis]) return true;
    met.lo.set(axis, at);
    met.hi.set(axis, at);
  }
  if (!triangle_meets_box(c, met, true)) return true;

  const Node node = geometry_.nodes[index];
  if (is_leaf(node)) {
    const auto refs = references(node);
    return std::find(refs.begin(), refs.end(), triangle) != refs.end();
  }
  const int axis = split_axis(node);
  const auto plane = static_cast<uint32_t>(split_plane(node));
  Box3u below = cell, above = cell;
  below.hi.set(axis, plane);
  above.lo.set(axis, plane);
  const uint32_t lower = child_of(node, 0), upper = child_of(node, 1);
  if (met.lo[axis] == plane && met.hi[axis] == plane) {
    return covered(triangle, c, lower, below) || covered(triangle, c, upper, above);
  }
  return covered(triangle, c, lower, below) && covered(triangle, c, upper, above);
}

void TreeCheck::coverage() const {
  parallel_ranges(geometry_.triangle_count(), 256, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const auto triangle = static_cast<uint32_t>(i);
      if (!covered(triangle, corners(triangle), 0, lattice_.cube())) {
        findings_.add(Issue::missing_reference, triangle, fmt::format("triangle {}", triangle));
      }
    }
  });
}

}  // namespace

std::vector<Finding> validate(const ObjectFile& file) {
  Findings findings;
  for (Finding& f : file.check_attributes()) findings.add(f.issue, 0, std::move(f.detail));
  const TreeCheck tree(file, findings);
  if (tree.planes_inside()) {
    tree.leaves();
    tree.coverage();
  }
  if (!(tree_statistics(file.geometry().nodes, file.summary().lattice) == file.summary().tree)) {
    findings.add(Issue::statistics, 0, "");
  }
  return findings.list();
}

}  // namespace kd::nkd
