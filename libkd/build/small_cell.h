// Cells of few triangles, where most nodes of a tree are made. Their splits are found from the triangles' boxes alone:
// counting, for eight planes at once, how many boxes lie on either side costs less than keeping events sorted from cell
// to cell.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "build/context.h"
#include "build/subtree.h"

namespace kd::build {

/// The largest cell built this way, in triangles.
constexpr uint32_t kSmallCell = 128;

/// The triangles of a cell and of the cells still open above it, one stack: each with the box of its part in its cell.
struct BoxStack {
  struct Interval {
    std::vector<int32_t> lo, hi;
  };
  std::array<Interval, 3> axes;
  std::vector<uint32_t> triangles;
  size_t size = 0;

  /// Makes room for `count` more.
  void reserve(size_t count);
  void push(uint32_t triangle, const Box3u& box);
};

/// Builds the subtree of `cell`, which has the triangles of `stack` from `first` to its end, in ascending order. Its
/// root goes to `slot`. Takes those triangles off the stack; what lies below them stays.
///
/// Greedy splitting is followed by a look back: a subtree that turns out no cheaper than one leaf becomes one. It lets
/// the bonus for empty space tempt the search without paying for it where nothing came of it.
void build_small_cell(const Context& context, const Box3u& cell, int depth, BoxStack& stack, size_t first,
                      uint32_t slot, Subtree& out);

}  // namespace kd::build
