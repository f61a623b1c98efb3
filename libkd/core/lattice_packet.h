// A packet of rays inside one object's lattice: what core/lattice_ray.h asks of a packet's numbers, to snap eight rays
// at once to what each is snapped to alone, to the bit. For host code.
#pragma once

#include "core/lattice_ray.h"
#include "core/packet.h"

namespace kd {

/// An axis of each ray.
struct PacketAxes {
  PacketTruths x, y;

  KD_INLINE int operator[](size_t ray) const { return x.lanes[ray] ? 0 : y.lanes[ray] ? 1 : 2; }

  KD_INLINE friend PacketTruths is_axis(PacketAxes axes, int which) {
    return which == 0 ? axes.x : which == 1 ? axes.y : !(axes.x | axes.y);
  }
  template <class T>
  KD_INLINE friend T component(Vec3<T> v, PacketAxes axes) {
    return select(axes.x, v.x, select(axes.y, v.y, v.z));
  }
};

/// Eight rays, each as a LatticeRay.
using LatticePacket = BasicLatticeRay<PacketFloats, PacketDoubles, PacketAxes>;

KD_INLINE LatticeRay ray_of(const LatticePacket& packet, size_t i) {
  const auto vector = [i](const Vec3<PacketFloats>& v) { return Vec3f{v.x[i], v.y[i], v.z[i]}; };
  LatticeRay ray;
  ray.origin = vector(packet.origin);
  ray.direction = vector(packet.direction);
  ray.inverse = vector(packet.inverse);
  ray.axis = packet.axis[i];
  ray.s_min = packet.s_min[i];
  ray.s_max = packet.s_max[i];
  ray.s_exit = packet.s_exit[i];
  ray.t_base = packet.t_base[i];
  ray.t_scale = packet.t_scale[i];
  return ray;
}

KD_INLINE PacketAxes largest_axis(Vec3<PacketDoubles> d) {
  const PacketDoubles ax = fabs(d.x), ay = fabs(d.y), az = fabs(d.z);
  const PacketTruths x = (ax >= ay) & (ax >= az);
  return {x, (ay >= az) & !x};
}

/// For each ray what pass_cube returns for it; without its branches, as the rays of a packet take different ones.
KD_INLINE PacketTruths pass_cube(Vec3<PacketDoubles> o, Vec3<PacketDoubles> d, double low, double high,
                                 PacketDoubles t_min, PacketDoubles t_max, PacketDoubles& t_enter) {
  const auto within = [&](PacketDoubles x) { return (x >= low) & (x <= high); };
  const PacketTruths inside =
      within(fma(t_min, d.x, o.x)) & within(fma(t_min, d.y, o.y)) & within(fma(t_min, d.z, o.z));
  const PacketTruths lasts = t_min <= t_max;
  t_enter = t_min;
  if (all(inside)) return lasts;
  PacketTruths passes = lasts & is_finite(o) & is_finite(d);
  PacketDoubles t_exit = t_max;
  for (int axis = 0; axis < 3; ++axis) {
    const PacketDoubles oa = o[axis], da = d[axis], per_step = 1 / da;
    const PacketDoubles t0 = (low - oa) * per_step, t1 = (high - oa) * per_step;
    const PacketTruths moves = da != 0;
    t_enter = select(moves, max_of(t_enter, min_of(t0, t1)), t_enter);
    t_exit = select(moves, min_of(t_exit, max_of(t0, t1)), t_exit);
    passes = passes & (moves | within(oa));
  }
  t_enter = select(inside, t_min, t_enter);
  return (inside & lasts) | (passes & (t_enter <= t_exit));
}

}  // namespace kd
