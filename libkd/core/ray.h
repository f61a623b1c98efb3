// Rays in scene or model space: points origin + t * direction with t in [t_min, t_max]. The direction need not have
// length 1, and t is the same number in every space a ray is taken to.
#pragma once

#include "core/vec.h"

namespace kd {

/// Of one ray, or of a packet's (core/packet.h).
template <class Double>
struct BasicRay {
  Vec3<Double> origin;
  Vec3<Double> direction;
  Double t_min = 0;
  Double t_max = 1e300;
};
using Ray = BasicRay<double>;

/// What is asked of a ray: the first thing it meets, or whether it meets anything.
enum class RayMode { closest, any };

}  // namespace kd
