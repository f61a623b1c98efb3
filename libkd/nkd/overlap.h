// Triangle and box, by the separating axis theorem, in exact integers.
#pragma once

#include <array>
#include <cstdint>

#include "core/box.h"
#include "core/vec.h"

namespace kd::nkd {

/// Whether the closed triangle meets the box. `open`: only the box's interior counts, along every axis on which it has
/// one; along an axis on which the box is flat its plane counts.
bool triangle_meets_box(const std::array<Vec3u, 3>& triangle, const Box3u& box, bool open);

}  // namespace kd::nkd
