// A split for cells that no plane parts at a profit, but two would.
#pragma once

#include "build/box_stack.h"
#include "build/context.h"
#include "build/split.h"

namespace kd::build {

/// How often a path through the tree may bisect. Each time may double the references of a bundle as thin as the
/// lattice, and is worth it for as many pieces as it has triangles.
constexpr int kMostBisections = 4;

/// What is left of a leaf's cost, at most, where bisecting it was worth while, as it turns out. Nearer to 1 Sponza's
/// fans of triangles, whose hub no plane takes apart, are split down to the lattice for nothing, and its primary rays
/// 16 % slower.
constexpr double kWorthBisecting = 0.7;

/// The best of the splits through the middle of `cell`, whose triangles are those of `stack` from `first` to its end,
/// judged by what can come of it: each half shrunk to the box of its triangles' parts. None is found where the cell
/// would be no fat leaf, or where nothing is gained.
///
/// A greedy builder leaves a bundle of long thin triangles along a cell's diagonal, a tube or a stalk, in one leaf:
/// each triangle is on both sides of any plane, and only then, in the halves, can empty corners be cut off.
Split bisection(const Context& context, const Box3u& cell, const BoxStack& stack, size_t first);

}  // namespace kd::build
