// A ray inside one object's lattice, snapped once and then the same for every triangle and plane of the object.
//
// Let k be the axis of the direction's largest component. The ray is written as a function of the distance s along k,
//
//   p(s) = origin + s * direction,   direction[k] = +-1,   t = t_base + s * t_scale,
//
// and both vectors are fixed-point: the origin lies on the grid of 2^(B-24) lattice steps (2^-24 of the cube, whatever
// B is) and the direction on that of 2^-24. Two things follow, and all that is exact rests on them:
//   - v - origin is exact in float32 for every lattice point v (24 bits, whatever their difference), and
//   - the coordinates of v sheared along the ray, (v - origin) - direction * s(v), are exact in double (48 bits).
// What snapping costs: the origin's plane along k is chosen on the grid and the ray evaluated there in double, so the
// ray moves only sideways: by at most half a grid step an axis at the origin (2^-25 of the cube) and, from the rounding
// of the direction, as much again at the far side of the cube. One exception: at 24 bits a ray that enters through a
// face along k may move by a whole step, because no float32 difference holds an origin farther outside the cube.
#pragma once

#include "core/arithmetic.h"
#include "core/lattice.h"
#include "core/ray.h"
#include "core/vec.h"

namespace kd {

/// Of one ray, or of a packet's (core/lattice_packet.h).
template <class FloatType, class DoubleType, class AxisType>
struct BasicLatticeRay {
  using Float = FloatType;
  using Double = DoubleType;
  using Axis = AxisType;

  Vec3<Float> origin;     // lattice steps, within one of the cube
  Vec3<Float> direction;  // lattice steps per unit of s; the component along `axis` is 1 or -1
  Vec3<Float> inverse;    // 1 / direction, rounded; kParallel where a component is 0
  Axis axis{};
  Float s_min = 0;  // the ray's own interval, >= 0
  Float s_max = 0;
  Float s_exit = 0;  // where the ray as snapped leaves the cube
  Double t_base = 0;
  Double t_scale = 1;

  KD_HD KD_INLINE Double t_at(Double s) const { return t_base + s * t_scale; }
};
using LatticeRay = BasicLatticeRay<float, double, int>;

/// Whether an axis is this one; a vector's component along it.
KD_HD KD_INLINE bool is_axis(int axis, int which) { return axis == which; }
template <class T>
KD_HD KD_INLINE T component(Vec3<T> v, int axis) {
  return v[axis];
}

/// Stands for 1/0. A ray parallel to a plane is thereby at distance +-2^58 or more from it unless it lies in it, and
/// then at distance 0: it counts as just past the plane, on the side of higher coordinates, which is also where the tie
/// rule of the triangle test moves it (`core/triangle.h`).
constexpr float kParallel = 1152921504606846976.0f;  // 2^60

/// Where the snapped ray leaves the cube [0, top]^3, off by at most 2.1 x 2^-24 of itself, as all distances of planes;
/// negative if it never is inside. Computed from what was snapped, where differences are exact, so it is right however
/// far away the ray came from.
template <class LatticeRayType>
KD_HD KD_INLINE auto exit_distance(const LatticeRayType& ray, float top) {
  using Float = typename LatticeRayType::Float;
  const auto leaves = [&](Float origin, Float inverse) {
    return (select(inverse > 0, Float(top), Float(0)) - origin) * inverse;
  };
  return least_of(leaves(ray.origin.x, ray.inverse.x), leaves(ray.origin.y, ray.inverse.y),
                  leaves(ray.origin.z, ray.inverse.z));
}

/// Where the ray first is in the cube [low, high]^3; false if it never is within [t_min, t_max], or is not finite.
KD_HD KD_INLINE bool pass_cube(Vec3d o, Vec3d d, double low, double high, double t_min, double t_max, double& t_enter) {
  t_enter = t_min;
  const auto within = [&](double x) { return x >= low && x <= high; };
  // Most rays of a scene start inside; they are spared the divisions.
  if (within(std::fma(t_min, d.x, o.x)) && within(std::fma(t_min, d.y, o.y)) && within(std::fma(t_min, d.z, o.z)))
    return t_min <= t_max;
  if (!(t_min <= t_max) || !is_finite(o) || !is_finite(d)) return false;
  double t_exit = t_max;
  for (int axis = 0; axis < 3; ++axis) {
    const double oa = o[axis], da = d[axis];
    if (da != 0) {
      const double per_step = 1 / da, t0 = (low - oa) * per_step, t1 = (high - oa) * per_step;
      t_enter = max_of(t_enter, min_of(t0, t1));
      t_exit = min_of(t_exit, max_of(t0, t1));
    } else if (!within(oa)) {
      return false;
    }
  }
  return t_enter <= t_exit;
}

/// The axis of the largest component.
KD_HD KD_INLINE int largest_axis(Vec3d d) {
  const double ax = std::fabs(d.x), ay = std::fabs(d.y), az = std::fabs(d.z);
  return ax >= ay && ax >= az ? 0 : ay >= az ? 1 : 2;
}

/// Takes a ray that is already in lattice space onto the grid. `o` and `d` are in lattice steps; they may be anything,
/// far away and NaN included. False: the ray has no point in the cube within [t_min, t_max], or is not a ray.
template <class LatticeRayType>
KD_HD KD_HOST_INLINE Truth<typename LatticeRayType::Double> snap_ray(Vec3<typename LatticeRayType::Double> o,
                                                                     Vec3<typename LatticeRayType::Double> d,
                                                                     typename LatticeRayType::Double t_min,
                                                                     typename LatticeRayType::Double t_max, int bits,
                                                                     LatticeRayType& ray) {
  using Float = typename LatticeRayType::Float;
  using Double = typename LatticeRayType::Double;
  using std::copysign, std::fabs, std::fma;
  const auto k = largest_axis(d);
  const Double ok = component(o, k), dk = component(d, k), speed = fabs(dk);
  const Truth<Double> moves = speed > 1e-300;
  if (!any(moves)) return Truth<Double>();

  const double grid = power_of_two(bits - kMaxLatticeBits);
  const auto top = static_cast<float>(lattice_max(bits));

  // Where the ray enters the cube, widened by a grid step on every side: snapping may bring it that much nearer.
  Double t_enter;
  const Truth<Double> enters = pass_cube(o, d, -grid, top + grid, t_min, t_max, t_enter);
  if (!any(enters)) return Truth<Double>();

  // The origin: on the last grid plane across k at or before the entry, inside the cube.
  const Double sign = copysign(Double(1), dk), entry = fma(t_enter, dk, ok) * sign;
  const Double nearest = rounded_to(entry, grid), before = select(nearest > entry, nearest - grid, nearest);
  const Float plane = least_of(largest_of(to_float(before * sign), Float(0)), Float(top));
  const Double t_scale = 1 / speed, t_base = (Double(plane) - ok) * sign * t_scale;
  const auto place = [&](int axis) {
    const Float p = to_float(rounded_to(fma(t_base, d[axis], o[axis]), grid));
    return select(is_axis(k, axis), plane, least_of(largest_of(p, Float(-1)), Float(top + 1)));
  };
  ray.origin = {place(0), place(1), place(2)};

  const auto turn = [&](Double da) { return to_float(rounded_to(da * t_scale, 0x1p-24)); };
  ray.direction = {turn(d.x), turn(d.y), turn(d.z)};
  const auto invert = [](Float c) {
    const Float inverse = reciprocal(c);
    return select(c == 0, Float(kParallel), inverse);
  };
  ray.inverse = {invert(ray.direction.x), invert(ray.direction.y), invert(ray.direction.z)};

  ray.axis = k;
  ray.t_base = t_base;
  ray.t_scale = t_scale;
  ray.s_min = largest_of(to_float((t_min - t_base) * speed), Float(0));
  ray.s_max = least_of(to_float((t_max - t_base) * speed), Float(1e30f));
  ray.s_exit = exit_distance(ray, top);
  return moves & enters & (ray.s_exit >= 0);
}

}  // namespace kd
