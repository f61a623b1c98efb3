// A triangle as its three corners.
#pragma once

#include <array>

#include "core/vec.h"

namespace kd::bench {

using Corners = std::array<Vec3d, 3>;  // model space

/// Length 1; zero for a triangle without area.
inline Vec3d normal_of(const Corners& c) { return normalised(cross(c[1] - c[0], c[2] - c[0])); }

}  // namespace kd::bench
