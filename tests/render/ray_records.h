// Rays of the kinds that lose hits, as records.
#pragma once

#include "../core/shapes.h"
#include "render/trace.h"

namespace kd::test {

/// Adversarial rays at a shape in the lattice, in model space and in no order; an eighth of them end on their way.
inline std::vector<render::RayRecord> adversarial_records(const Shape& shape, const Lattice& lattice, size_t count,
                                                          uint64_t seed) {
  const Frame frame = lattice.frame();
  Random random(seed);
  std::vector<render::RayRecord> rays;
  for (size_t i = 0; i < count; ++i) {
    const PlainRay ray = adversarial_ray(shape, lattice.bits, random);
    const Vec3f o = vec_cast<float>(frame.apply_point(ray.origin)),
                d = vec_cast<float>(frame.apply_vector(ray.direction));
    rays.push_back({o.x, o.y, o.z, 0, d.x, d.y, d.z, random.chance(0.125) ? 0.9f : 1e30f});
  }
  return rays;
}

}  // namespace kd::test
