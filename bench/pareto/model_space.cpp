#include "pareto/model_space.h"

#include <cmath>

#include "core/float_triangle.h"

namespace kd::bench {

namespace {

/// The ray as the tests take it (core/lattice_ray.h), in model space and float32 throughout.
LatticeRay model_ray(const render::RayRecord& r) {
  const float ax = std::fabs(r.dx), ay = std::fabs(r.dy), az = std::fabs(r.dz);
  const float scale = 1 / max_of(ax, ay, az);
  LatticeRay ray;
  ray.origin = {r.ox, r.oy, r.oz};
  ray.axis = ax >= ay && ax >= az ? 0 : ay >= az ? 1 : 2;
  ray.direction = Vec3f{r.dx, r.dy, r.dz} * scale;
  ray.direction.set(ray.axis, std::copysign(1.0f, ray.direction[ray.axis]));
  ray.t_scale = static_cast<double>(scale);
  return ray;
}

template <class Method>
Spread depth_error(const View& view, const ReferenceRender& reference, const CornersOf& corners) {
  std::vector<double> errors;
  for (size_t i = 0; i < reference.hits.size(); ++i) {
    if (reference.hits[i].primitive < 0) continue;
    const Corners c = corners(reference.hits[i].primitive);
    TriangleVertices triangle;
    triangle.a = vec_cast<float>(c[0]);
    triangle.b = vec_cast<float>(c[1]);
    triangle.c = vec_cast<float>(c[2]);
    const LatticeRay ray = model_ray(view.primary.rays[i]);
    FloatHit hit;
    if (!Method::intersect(ray, triangle, 1e30f, hit)) continue;
    const float t = hit.s * static_cast<float>(ray.t_scale);
    errors.push_back(std::fabs(static_cast<double>(t) - reference.t[i]) *
                     length(to_ray(view.primary.rays[i]).direction));
  }
  return spread(std::move(errors));
}

}  // namespace

ModelSpaceDepth model_space_depth(const View& view, const ReferenceRender& reference, const CornersOf& corners) {
  return {depth_error<MollerTrumbore>(view, reference, corners), depth_error<Woop>(view, reference, corners)};
}

}  // namespace kd::bench
