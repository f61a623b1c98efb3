// The stages that trace rays, for the pixels of a packet at once: the same results as stage(pixel) for each of them.
#pragma once

#include "render/packet_intersection.h"
#include "render/stages/colour.h"

namespace kd::render {

/// Returns the sum of what stage(pixel) returns for `pixels` of `set`.
template <class Instances>
uint64_t run_packet(const ObjectIntersection<Instances>& stage, const PerRay<uint32_t>& pixels, RaySet set) {
  const FrameView& frame = stage.frame;
  PerRay<Ray> rays;
  for_each_ray(set, [&](size_t i) { rays[i] = primary_ray(frame, pixels[i]); });
  PerRay<SurfaceHit> hits;
  closest_hits<Instances>(frame.scene, rays, set, hits);
  uint64_t count = 0;
  for_each_ray(set, [&](size_t i) {
    frame.hits[pixels[i]] = hits[i];
    count += hits[i].instance != kNone;
  });
  return count;
}

template <class Instances>
uint64_t run_packet(const Lighting<Instances>& stage, const PerRay<uint32_t>& pixels, RaySet set) {
  const FrameView& frame = stage.frame;
  PerRay<SurfaceHit> hits;
  PerRay<Ray> rays;
  PerRay<Excluded> excluded;
  PerRay<Vec3f> added;
  RaySet asked = kNoRays;
  for_each_ray(set, [&](size_t i) {
    hits[i] = frame.hits[pixels[i]];
    const bool asks = stage.ask(pixels[i], hits[i], [&](const Ray& ray, Vec3f colour) {
      rays[i] = ray;
      excluded[i] = {hits[i].instance, hits[i].triangle};
      added[i] = colour;
    });
    if (asks) asked |= set_of(i);
  });
  const RaySet lit = asked & ~any_hits<Instances>(frame.scene, rays, excluded, asked);
  for_each_ray(set, [&](size_t i) { stage.add(pixels[i], hits[i], (lit & set_of(i)) != kNoRays, added[i]); });
  return static_cast<uint64_t>(std::popcount(asked));
}

}  // namespace kd::render
