// What a cell is expected to cost a ray that meets it, as a leaf and when it is split: by these figures the builder
// chooses splits, and stops.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "build/context.h"
#include "core/node.h"

namespace kd::build {

constexpr double kReferenceBytes = sizeof(uint32_t);
constexpr double kNodeBytes = sizeof(Node);

constexpr double leaf_bytes(uint32_t n) { return n == 0 ? 0 : kNodeBytes + kReferenceBytes * n; }

/// How many triangle tests' worth a ray is expected to do in a cell of n triangles. A greedy builder that takes it for
/// n overrates large cells, which will be split further: there each doubling multiplies it only by kDoubling. Both
/// constants by a sweep over scans and architecture: 1 to 2 % less SAH cost than n on either.
///
/// Linear between powers of two, and concave: the least of its lines.
class ExpectedTests {
 public:
  struct Line {
    double intercept, slope;
  };
  static constexpr uint32_t kLinear = 16;  // up to here it is n
  static constexpr double kDoubling = 1.7;

  static constexpr std::array<Line, 30> kLines = [] {
    std::array<Line, 30> lines{};
    lines[0] = {0, 1};
    double n = kLinear, tests = kLinear;
    for (size_t i = 1; i < lines.size(); ++i) {
      const double slope = tests * (kDoubling - 1) / n;
      lines[i] = {tests - slope * n, slope};
      n *= 2;
      tests *= kDoubling;
    }
    return lines;
  }();

  static double of(uint32_t n) {
    const Line& line = kLines[static_cast<size_t>(std::bit_width(n / kLinear))];
    return line.intercept + line.slope * n;
  }
};

/// The prices in one cell. Costs are per ray that meets the cell, so a byte costs more the fewer rays do; and next to
/// nothing where a leaf would be fat. Else parts of the mesh that few rays meet, but perhaps all rays of one picture,
/// would be left in a few leaves of hundreds of triangles, which cost little memory but hold up a whole image. But not
/// nothing: n triangles around a hub, or in a bundle, may be cut into n pieces that have all n, each time for a little.
struct CellCosts {
  static constexpr uint32_t kFullLeaf = 16;  // triangles
  /// Share of the price on memory that holds above that. At 1/100 the staircase's longest rays take a third longer than
  /// at 0; at 1/300 they do not, and its file is 11 % smaller than at 0, Sponza's 15, that of a disc of 5000 triangles
  /// around one vertex 72 %. A share that grows with n keeps no more.
  static constexpr double kFatShare = 1.0 / 300;

  double traversal, intersection;
  double kept;  // of a split's cost where one side is empty
  double byte;

  CellCosts(const Context& context, const Box3u& cell, uint32_t count)
      : traversal(context.costs.traversal),
        intersection(context.costs.intersection),
        kept(1 - context.costs.empty_bonus),
        byte(0) {
    if (context.area_price > 0)
      byte = context.area_price / context.half_area_of(cell) * (count <= kFullLeaf ? 1 : kFatShare);
  }

  double leaf(uint32_t n) const { return intersection * n + byte * leaf_bytes(n); }
  /// A split into n_below and n_above triangles, on which rays do `tests` tests on average.
  double split(double tests, uint32_t n_below, uint32_t n_above) const {
    const bool one_empty = n_below == 0 || n_above == 0;
    const double sah = traversal + intersection * tests;
    return (one_empty ? kept * sah : sah) + bytes_of(n_below, n_above);
  }
  /// Of two leaves and the node above them.
  double bytes_of(uint32_t n_below, uint32_t n_above) const {
    const bool one_empty = n_below == 0 || n_above == 0;
    return byte * (kReferenceBytes * (double{1} * n_below + n_above) + kNodeBytes * (one_empty ? 2 : 3));
  }
  /// Whether no split of n triangles can be cheaper than a leaf, wherever they lie.
  bool hopeless(uint32_t n) const { return kept * traversal + byte * kNodeBytes >= intersection * n; }
};

/// Probabilities that a ray which meets the cell meets its part below or above a plane across one axis.
struct PlaneProbability {
  double lo, hi;
  double constant;  // of the face across the axis
  double per_step;  // of the sides, for each lattice step along the axis

  PlaneProbability(const Box3u& cell, int axis, Vec3d step) : lo(cell.lo[axis]), hi(cell.hi[axis]) {
    const Vec3d edges = vec_cast<double>(cell.extent()) * step;
    const double e1 = edges[(axis + 1) % 3], e2 = edges[(axis + 2) % 3];
    const double area = half_area(edges);
    constant = area > 0 ? e1 * e2 / area : 1;
    per_step = area > 0 ? (e1 + e2) / area * step[axis] : 0;
  }
  double below(double plane) const { return constant + per_step * (plane - lo); }
  double above(double plane) const { return constant + per_step * (hi - plane); }
};

}  // namespace kd::build
