// Polygons to triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"

namespace kd::mesh {

/// Polygons of more corners than this are fanned whatever their shape: ear clipping takes cubic time at worst.
constexpr size_t kMostClippedCorners = 1000;

/// Replaces `triangles` by the corners.size() - 2 triangles (none for fewer than three corners) of a polygon given by
/// its corners in order; indices are into `corners`. A convex polygon is fanned from its first corner, a concave one is
/// clipped ear by ear. A polygon that has no ear left (it crosses itself, or has no area) loses no corner: one is cut
/// off as if it were an ear. Corners may be anything, NaN included.
void triangulate_polygon(std::span<const Vec3d> corners, std::vector<std::array<uint32_t, 3>>& triangles);

}  // namespace kd::mesh
