#include "pareto/render.h"

#include <algorithm>

#include "sys/parallel.h"

namespace kd::bench {

namespace {

constexpr Vec3f kBackground{0.25f, 0.35f, 0.5f}, kAmbient{0.10f, 0.11f, 0.13f};
constexpr Vec3d kDiffuse{0.78, 0.74, 0.68};
constexpr size_t kRayGrain = 512;

}  // namespace

Picture shade(const View& view, std::span<const render::HitRecord> hits, const CornersOf& corners,
              std::span<const uint8_t> lit) {
  Picture out{view.width, view.height, {}};
  out.pixels.assign(hits.size(), kBackground);
  size_t hit = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].primitive < 0) continue;
    Vec3f& pixel = out.pixels[view.primary.pixels[i]];
    pixel = kAmbient;
    if (!lit[hit++]) continue;
    const SurfacePoint at = surface_point(view.primary.rays[i], hits[i].t, corners(hits[i].primitive), view.diagonal);
    const double cosine = dot(normalised(view.camera.light - at.lifted), at.normal);
    if (cosine > 0) pixel = pixel + vec_cast<float>(kDiffuse * cosine);
  }
  return out;
}

ReferenceRender render_reference(const View& view, const ReferenceTracer& tracer, std::span<const uint32_t> sources) {
  const std::vector<render::RayRecord>& rays = view.primary.rays;
  ReferenceRender out;
  out.t.resize(rays.size());
  out.hits.resize(rays.size());
  std::vector<uint32_t> triangle_of(*std::max_element(sources.begin(), sources.end()) + size_t{1});
  for (uint32_t i = 0; i < sources.size(); ++i) triangle_of[sources[i]] = i;
  parallel_ranges(rays.size(), kRayGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const ReferenceHit hit = tracer.closest_hit(to_ray(rays[i]));
      out.t[i] = hit.t;
      out.hits[i] = {rays[i].t_max, -1, 0, 0};
      if (hit.triangle < 0) continue;
      out.hits[i] = {static_cast<float>(hit.t), static_cast<int32_t>(sources[static_cast<size_t>(hit.triangle)]),
                     static_cast<float>(hit.u), static_cast<float>(hit.v)};
    }
  });
  const CornersOf corners = [&](int64_t primitive) {
    return tracer.triangles()[triangle_of[static_cast<size_t>(primitive)]];
  };
  out.secondary = secondary_rays(corners, view.diagonal, view.camera, view.primary, out.hits);
  std::vector<uint8_t> lit(out.secondary.shadow.size());
  parallel_ranges(lit.size(), kRayGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) lit[i] = !tracer.any_hit(to_ray(out.secondary.shadow[i]));
  });
  out.picture = shade(view, out.hits, corners, lit);
  return out;
}

}  // namespace kd::bench
