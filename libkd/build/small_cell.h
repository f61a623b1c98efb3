// Cells of few triangles, where most nodes of a tree are made. Their splits are found from the triangles' boxes alone:
// counting, for eight planes at once, how many boxes lie on either side costs less than keeping events sorted from cell
// to cell.
#pragma once

#include <cstdint>

#include "build/box_stack.h"
#include "build/context.h"
#include "build/subtree.h"

namespace kd::build {

/// The largest cell built this way, in triangles.
constexpr uint32_t kSmallCell = 128;

/// Builds the subtree of `cell`, which has the triangles of `stack` from `first` to its end, in ascending order. Its
/// root goes to `slot`; `bisections`: of the cells it is in. Takes those triangles off the stack; what lies below them
/// stays.
///
/// Greedy splitting is followed by a look back: a subtree that turns out no cheaper than one leaf becomes one. It lets
/// the bonus for empty space tempt the search without paying for it where nothing came of it.
void build_small_cell(const Context& context, const Box3u& cell, int depth, int bisections, BoxStack& stack,
                      size_t first, uint32_t slot, Subtree& out);

}  // namespace kd::build
