#include "pareto/hit_errors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kd::bench {

namespace {

Vec3d facing_normal(const Corners& corners, Vec3d direction) {
  const Vec3d n = normal_of(corners);
  return dot(n, direction) > 0 ? -n : n;
}

double degrees_between(Vec3d a, Vec3d b) {
  return std::atan2(length(cross(a, b)), dot(a, b)) * (180 / std::numbers::pi);
}

/// Whether on the source mesh the ray meets `other` where it meets the triangle at t.
bool in_one_place(const Ray& ray, double t, const Corners& other) {
  ReferenceHit hit;
  return meets(ray, other, hit) && std::fabs(hit.t - t) * length(ray.direction) <=
                                       0x1p-22 * (std::fabs(t) * length(ray.direction) + length(ray.origin));
}

}  // namespace

Spread spread(std::vector<double> sizes) {
  Spread out;
  if (sizes.empty()) return out;
  std::sort(sizes.begin(), sizes.end());
  const auto rank = [&](double share) {
    return sizes[static_cast<size_t>(std::ceil(share * static_cast<double>(sizes.size()))) - 1];
  };
  double sum = 0;
  for (double size : sizes) sum += size * size;
  return {rank(0.5), rank(0.99), std::sqrt(sum / static_cast<double>(sizes.size())), sizes.back()};
}

HitErrors hit_errors(const View& view, const ReferenceRender& reference, std::span<const render::HitRecord> hits,
                     const TwoSurfaces& surfaces) {
  HitErrors out;
  out.pixels = hits.size();
  std::vector<double> depth, relative, normal;
  for (size_t i = 0; i < hits.size(); ++i) {
    const int32_t expected = reference.hits[i].primitive, found = hits[i].primitive;
    out.reference_hits += expected >= 0;
    if (expected < 0 || found < 0) {
      out.missed += expected >= 0;
      out.false_hits += found >= 0;
      continue;
    }
    const Ray ray = to_ray(view.primary.rays[i]);
    if (found != expected) {
      const bool coincident = in_one_place(ray, reference.t[i], surfaces.reference(found));
      ++(coincident ? out.coincident : out.wrong);
      continue;
    }
    ++out.same;
    const double error = std::fabs(static_cast<double>(hits[i].t) - reference.t[i]);
    depth.push_back(error * length(ray.direction));
    relative.push_back(error / reference.t[i]);
    normal.push_back(degrees_between(facing_normal(surfaces.reference(expected), ray.direction),
                                     facing_normal(surfaces.form(found), ray.direction)));
  }
  out.depth = spread(std::move(depth));
  out.relative_depth = spread(std::move(relative));
  out.normal = spread(std::move(normal));
  return out;
}

}  // namespace kd::bench
