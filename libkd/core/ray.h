// Rays in scene or model space: points origin + t * direction with t in [t_min, t_max]. The direction need not have
// length 1, and t is the same number in every space a ray is taken to.
#pragma once

#include "core/vec.h"

namespace kd {

struct Ray {
  Vec3d origin;
  Vec3d direction;
  double t_min = 0;
  double t_max = 1e300;
};

/// What is asked of a ray: the first thing it meets, or whether it meets anything.
enum class RayMode { closest, any };

}  // namespace kd
