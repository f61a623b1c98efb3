// Vertices that are one point: equal in value, whatever their indices.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "mesh/watch.h"

namespace kd::mesh {

/// Per position the smallest index of a position equal to it; -0 equals 0, and a NaN the same NaN. O(N log N).
std::vector<uint32_t> weld(std::span<const Vec3d> positions, Watch& watch);
std::vector<uint32_t> weld(std::span<const Vec3d> positions);

}  // namespace kd::mesh
