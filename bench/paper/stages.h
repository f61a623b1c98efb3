// The stages of DiNatale and Kylstra's pipeline as the paper has them: each a launch of its own, with buffers between
// them. What they compute with is the product's: its rays, traversal, surfaces and colours.
//
// A stage is called for every pixel of a strip of the film and for every plane of what it writes: an instance, a light,
// or a light and an instance. A plane of a buffer has one element a pixel of the strip.
#pragma once

#include "render/stages/ambient.h"
#include "render/stages/colour.h"
#include "render/stages/gamma.h"
#include "render/stages/object_intersection.h"
#include "render/stages/ray_generation.h"

namespace kd::bench::paper {

using render::Excluded;
using render::FrameView;
using render::kNone;
using render::LightView;
using OnlyInstance = render::OnlyInstance<>;
using render::SceneView;
using render::Surface;
using render::SurfaceHit;
using render::ToLight;

/// A strip of the film and the buffers of its pixels. Those that no stage of a form uses are null.
struct StripView {
  FrameView frame;
  uint32_t first = 0;   // pixel of the film
  uint32_t pixels = 0;  // whole rows
  Ray* rays = nullptr;
  SurfaceHit* intersections = nullptr;  // a plane an instance
  Ray* shadow_rays = nullptr;           // a plane a light; those that ask nothing have a t_max below 0
  uint8_t* occluded = nullptr;          // one or more planes a light: 1 where something is in the light's way

  KD_HD KD_INLINE uint64_t at(uint32_t pixel, uint32_t plane) const { return uint64_t{plane} * pixels + pixel; }
  KD_HD KD_INLINE SurfaceHit& hit(uint32_t pixel) const { return frame.hits[first + pixel]; }
};

/// The scene as if there were no other instance; that one has index 0 in it.
KD_HD KD_INLINE SceneView only(SceneView scene, uint32_t instance) {
  scene.instances += instance;
  scene.instance_count = 1;
  return scene;
}

/// Has the interface of render::ThroughHierarchy: every instance, wherever it is.
struct AllInstances {
  static constexpr TriangleLayout kLayout = TriangleLayout::expanded;
  using Sides = render::BothSides;

  template <class Visit>
  KD_HD static void for_each(const SceneView& scene, const Ray&, const double&, const Visit& visit) {
    for (uint32_t i = 0; i < scene.instance_count; ++i) {
      if (!visit(i)) return;
    }
  }
};

/// Within an object the traversal ends at the first triangle it meets, here too: the answer is the same, and the paper
/// does not say that theirs went on.
KD_HD inline bool occluded_by(const SceneView& scene, uint32_t instance, const Ray& ray, const SurfaceHit& from) {
  return render::any_hit<OnlyInstance>(only(scene, instance), ray,
                                       {from.instance == instance ? 0 : kNone, from.triangle});
}

/// A stage of the product over a strip.
template <class Stage>
struct OverStrip {
  static constexpr const char* kName = Stage::kName;
  StripView strip;
  Stage stage;

  KD_HD void operator()(uint32_t pixel, uint32_t) const { stage(strip.first + pixel); }
};

struct RayGeneration {
  static constexpr const char* kName = "ray generation";
  StripView strip;

  KD_HD void operator()(uint32_t pixel, uint32_t) const {
    strip.rays[pixel] = render::primary_ray(strip.frame, strip.first + pixel);
  }
};

/// One intersection for each ray and instance.
struct DenseIntersection {
  static constexpr const char* kName = "object intersection";
  StripView strip;

  KD_HD void operator()(uint32_t pixel, uint32_t instance) const {
    SurfaceHit hit = render::closest_hit<OnlyInstance>(only(strip.frame.scene, instance), strip.rays[pixel]);
    if (hit.instance != kNone) hit.instance = instance;
    strip.intersections[strip.at(pixel, instance)] = hit;
  }
};

/// One step of a stride reduction over the first `count` intersections of each pixel: `stride` of them are left, for a
/// `stride` of at least half of `count`. The step that leaves one writes it to the frame.
struct IntersectionReduction {
  static constexpr const char* kName = "intersection reduction";
  StripView strip;
  uint32_t count = 0;
  uint32_t stride = 0;

  KD_HD void operator()(uint32_t pixel, uint32_t plane) const {
    SurfaceHit best = strip.intersections[strip.at(pixel, plane)];
    if (plane + stride < count) {
      const SurfaceHit other = strip.intersections[strip.at(pixel, plane + stride)];
      if (other.instance != kNone) render::reduce(best, other);
    }
    (stride == 1 ? strip.hit(pixel) : strip.intersections[strip.at(pixel, plane)]) = best;
  }
};

/// Intersection and reduction in one, hit by hit.
template <class Instances>
struct ReducedIntersection {
  static constexpr const char* kName = "object intersection";
  StripView strip;

  KD_HD void operator()(uint32_t pixel, uint32_t) const {
    strip.hit(pixel) = render::closest_hit<Instances>(strip.frame.scene, strip.rays[pixel]);
  }
};

/// A ray from each surface to each light, or with `only_facing` only to lights that it faces.
struct ShadowRays {
  static constexpr const char* kName = "shadow rays";
  StripView strip;
  bool only_facing = false;

  KD_HD void operator()(uint32_t pixel, uint32_t light) const {
    const SurfaceHit hit = strip.hit(pixel);
    Ray ray{{0, 0, 0}, {0, 0, 0}, 0, -1};
    if (hit.instance != kNone) {
      const SceneView& scene = strip.frame.scene;
      const Surface surface = render::surface_at(scene, hit, strip.rays[pixel].direction);
      const ToLight way = render::to_light(scene.lights[light], surface.shadow_origin, render::kFar);
      if (!only_facing || render::faces(surface, way)) ray = {surface.shadow_origin, way.direction, 0, way.distance};
    }
    strip.shadow_rays[strip.at(pixel, light)] = ray;
  }
};

/// One test for each pixel, light and instance; the planes of a light follow each other.
struct DenseShadow {
  static constexpr const char* kName = "shadow";
  StripView strip;

  KD_HD void operator()(uint32_t pixel, uint32_t plane) const {
    const SceneView& scene = strip.frame.scene;
    const uint32_t light = plane / scene.instance_count, instance = plane % scene.instance_count;
    const Ray ray = strip.shadow_rays[strip.at(pixel, light)];
    strip.occluded[strip.at(pixel, plane)] = occluded_by(scene, instance, ray, strip.hit(pixel));
  }
};

/// As IntersectionReduction, over the tests of each pixel and light; what is left stays in the light's first plane.
struct ShadowReduction {
  static constexpr const char* kName = "shadow reduction";
  StripView strip;
  uint32_t count = 0;
  uint32_t stride = 0;

  KD_HD void operator()(uint32_t pixel, uint32_t plane) const {
    const uint32_t light = plane / stride, i = plane % stride;
    const uint32_t first = light * strip.frame.scene.instance_count + i;
    if (i + stride < count) strip.occluded[strip.at(pixel, first)] |= strip.occluded[strip.at(pixel, first + stride)];
  }
};

/// The same tests added up as they come, in one plane a light: all of them, or up to the first occluder.
template <class Instances, bool up_to_first>
struct ReducedShadow {
  static constexpr const char* kName = "shadow";
  StripView strip;

  KD_HD void operator()(uint32_t pixel, uint32_t light) const {
    const SceneView& scene = strip.frame.scene;
    const Ray ray = strip.shadow_rays[strip.at(pixel, light)];
    const SurfaceHit hit = strip.hit(pixel);
    bool met = false;
    if constexpr (up_to_first) {
      met = render::any_hit<Instances>(scene, ray, {hit.instance, hit.triangle});
    } else {
      Instances::for_each(scene, ray, ray.t_max, [&](uint32_t instance) {
        met |= occluded_by(scene, instance, ray, hit);
        return true;
      });
    }
    strip.occluded[strip.at(pixel, light)] = met;
  }
};

/// What one light adds. `planes`: of `occluded`, a light.
struct Colour {
  static constexpr const char* kName = "colour";
  StripView strip;
  uint32_t light = 0;
  uint32_t planes = 1;

  KD_HD void operator()(uint32_t pixel, uint32_t) const {
    const SurfaceHit hit = strip.hit(pixel);
    if (hit.instance == kNone || strip.occluded[strip.at(pixel, light * planes)]) return;
    const SceneView& scene = strip.frame.scene;
    const LightView& source = scene.lights[light];
    const Vec3d direction = strip.rays[pixel].direction;
    const Surface surface = render::surface_at(scene, hit, direction);
    const ToLight way = render::to_light(source, surface.shadow_origin, render::kFar);
    const float share = render::arriving(source, way);
    if (!(share > 0) || !render::faces(surface, way)) return;
    Vec3f& colour = strip.frame.colour[strip.first + pixel].colour;
    colour =
        colour + render::reflected(source, surface, render::material_at(scene, hit), way.direction, direction) * share;
  }
};

}  // namespace kd::bench::paper
