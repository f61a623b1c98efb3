// A ray in an object's lattice as the float triangle tests want it (core/float_triangle.h): rounded to float32, not
// snapped. For benchmarks.
#pragma once

#include "core/lattice_ray.h"

namespace kd::render {

/// As snap_ray, but origin and direction are the nearest floats, and the origin lies where the ray enters a cube that
/// is larger by 2^-16 on every side: no hit on the object's box is lost to the rounding of s. Traversal's margins
/// (core/traversal.h) hold for such a ray too: plane - origin is rounded once more, so 2.1 e there becomes 3.1 e.
KD_HD inline bool float_ray(Vec3d o, Vec3d d, double t_min, double t_max, int bits, LatticeRay& ray) {
  const int k = largest_axis(d);
  const double speed = std::fabs(d[k]);
  if (!(speed > 1e-300)) return false;
  const double top = lattice_max(bits), low = top * -0x1p-16, high = top - low;
  double t_enter;
  if (!pass_cube(o, d, low, high, t_min, t_max, t_enter)) return false;

  const double t_scale = 1 / speed;
  ray.origin = vec_cast<float>(o + d * t_enter);
  ray.direction = vec_cast<float>(d * t_scale);
  const auto invert = [](float c) { return c == 0 ? kParallel : 1.0f / c; };
  ray.inverse = {invert(ray.direction.x), invert(ray.direction.y), invert(ray.direction.z)};
  ray.axis = k;
  ray.t_base = t_enter;
  ray.t_scale = t_scale;
  ray.s_min = 0;
  ray.s_max = static_cast<float>(min_of((t_max - t_enter) * speed, 1e30));
  ray.s_exit = exit_distance(ray, static_cast<float>(top));
  return ray.s_exit >= 0;
}

}  // namespace kd::render
