// The rays of a stress run, in classes. Each is a function of its case, class, seed and number.
#pragma once

#include "stress/ray_recipes.h"

namespace kd::stress {

KD_HD inline Query make_query(const CaseView& c, RayClass ray_class, uint64_t seed, uint64_t index) {
  using namespace detail;
  Random random(seed, index);
  Query q = random_query(c, ray_class, index, random);
  switch (ray_class) {
    case RayClass::vertices:
    case RayClass::edges:
    case RayClass::faces:
      break;
    case RayClass::exact:
      exact_slopes(c, index, random, q);
      break;
    case RayClass::planes:
      in_a_split_plane(c, index, random, q);
      break;
    case RayClass::grid:
      through_lattice_points(c, index, random, q);
      break;
    case RayClass::grazing:
      in_a_triangles_plane(c, random, q);
      break;
    case RayClass::along:
      from_vertex_to_vertex(c, random, q);
      break;
    case RayClass::near_axis: {
      const Vec3d target = q.origin + q.direction;
      const Vec3d d = with_some_axis(random.vector(random.magnitude(-12, -7)), random);
      q = {target - d * (3 * c.top()), d};
      break;
    }
    case RayClass::far_away: {
      const Vec3d d = some_direction(random), target = q.origin + q.direction;
      q = {target - d * (c.top() * random.magnitude(3, 8)), d * random.magnitude(-3, 3)};
      break;
    }
    case RayClass::segments: {
      const double spread = random.chance(0.5) ? 0 : random.either_magnitude(-9, -1);
      if (random.chance(0.5)) q.t_min = random.unit();
      if (random.chance(0.3)) q.t_min = 1 - spread;
      if (random.chance(0.7)) q.t_max = max_of(1 + spread, q.t_min);
      break;
    }
    case RayClass::inside:
      from_inside(c, seed, index, random, q);
      return q;
    case RayClass::model:
      if (c.traits.inside && (index & 1) != 0) from_inside(c, seed, index / 2, random, q);
      as_record(c, q);
      break;
    case RayClass::frames:
      if (c.traits.inside && (index & 1) != 0) from_inside(c, seed, index / 2, random, q);
      through_frame(c, 1 + static_cast<uint32_t>(index / 2 % kSceneFrames), q);
      break;
    case RayClass::shadow:
      q.origin = some_point(c, random, 1);
      q.origin = q.origin + some_direction(random) * (2 * c.top());
      q.direction = some_feature(c, index, random) - q.origin;
      cast_shadow(c, static_cast<uint32_t>(index % (1 + kSceneFrames)), 0, random, q);
      return q;
    case RayClass::contact: {
      // Straight down on a sheet, from just above it, beneath the one that it touches.
      const OracleTriangle t = some_triangle(c, random);
      Vec3d p = (vec_cast<double>(t.a) + vec_cast<double>(t.b) + vec_cast<double>(t.c)) * (1.0 / 3);
      p.z = c.traits.inside_point.z;
      q = {p, {0, 0, -1}};
      cast_shadow(c, 0, 0.05, random, q);
      if (q.excluded != kNoTriangle) q.demand = Demand::occluded;
      return q;
    }
  }
  if (q.demand == Demand::none && c.traits.even && ray_class != RayClass::segments && starts_outside(c, q.origin))
    q.demand = Demand::even;
  return q;
}

}  // namespace kd::stress
