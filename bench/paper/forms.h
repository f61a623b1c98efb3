// Forms of the pipeline between the paper's and ours: each is the one before it with one change, composed of the same
// stages, and all have the same film to the bit. The last step, to render::run_pipeline, is the product itself.
#pragma once

#include <algorithm>

#include "paper/stages.h"

namespace kd::bench::paper {

enum class Form { dense, hit_by_hit, hierarchy, first_occluder };

/// How many elements the buffers of a strip have.
struct Buffers {
  uint64_t rays = 0;
  uint64_t intersections = 0;
  uint64_t shadow_rays = 0;
  uint64_t shadow_tests = 0;

  uint64_t bytes() const {
    return (rays + shadow_rays) * sizeof(Ray) + intersections * sizeof(SurfaceHit) + shadow_tests;
  }
};

inline Buffers buffers_of(Form form, uint64_t pixels, uint64_t instances, uint64_t lights) {
  const bool dense = form == Form::dense;
  return {pixels, dense ? pixels * instances : 0, pixels * lights, pixels * lights * (dense ? instances : 1)};
}

/// Rows of the film whose buffers take no more than `most_bytes`: all, or a multiple of four as a warp's tile has it if
/// there are as many; 0 if not even one fits.
inline uint32_t rows_that_fit(Form form, const FrameView& frame, uint64_t lights, uint64_t most_bytes) {
  const uint64_t row = buffers_of(form, frame.width, frame.scene.instance_count, lights).bytes();
  const uint64_t fit = most_bytes / row;
  if (fit >= frame.height) return frame.height;
  return static_cast<uint32_t>(fit < 4 ? fit : fit / 4 * 4);
}

/// `step(count, stride)` for each step of a stride reduction of `count` elements, at least one, to one.
template <class Step>
void stride_reduction(uint32_t count, const Step& step) {
  do {
    const uint32_t stride = (count + 1) / 2;
    step(count, stride);
    count = stride;
  } while (count > 1);
}

/// The paper's: every ray against every instance, every intersection stored, then reduced.
template <class Launch>
void run_dense(const StripView& strip, uint32_t lights, const Launch& launch) {
  const uint32_t instances = strip.frame.scene.instance_count;
  launch(RayGeneration{strip}, 1);
  launch(DenseIntersection{strip}, instances);
  stride_reduction(instances, [&](uint32_t count, uint32_t stride) {
    launch(IntersectionReduction{strip, count, stride}, stride);
  });
  launch(OverStrip<render::Ambient>{strip, {strip.frame}}, 1);
  if (lights == 0) return;
  launch(ShadowRays{strip, false}, lights);
  launch(DenseShadow{strip}, lights * instances);
  stride_reduction(instances, [&](uint32_t count, uint32_t stride) {
    launch(ShadowReduction{strip, count, stride}, lights * stride);
  });
  for (uint32_t light = 0; light < lights; ++light) launch(Colour{strip, light, instances}, 1);
}

template <class Instances, bool up_to_first, class Launch>
void run_reduced(const StripView& strip, uint32_t lights, const Launch& launch) {
  launch(RayGeneration{strip}, 1);
  launch(ReducedIntersection<Instances>{strip}, 1);
  launch(OverStrip<render::Ambient>{strip, {strip.frame}}, 1);
  if (lights == 0) return;
  launch(ShadowRays{strip, up_to_first}, lights);
  launch(ReducedShadow<Instances, up_to_first>{strip}, lights);
  for (uint32_t light = 0; light < lights; ++light) launch(Colour{strip, light, 1}, 1);
}

/// `launch(stage, planes)` runs stage(pixel, plane) for all of them, after all stages before it.
template <class Launch>
void run_form(Form form, const StripView& strip, uint32_t lights, const Launch& launch) {
  // As in the product, a scene of one instance has no use for a hierarchy.
  const bool alone = strip.frame.scene.instance_count == 1;
  switch (form) {
    case Form::dense:
      return run_dense(strip, lights, launch);
    case Form::hit_by_hit:
      return run_reduced<AllInstances, false>(strip, lights, launch);
    case Form::hierarchy:
      return alone ? run_reduced<OnlyInstance, false>(strip, lights, launch)
                   : run_reduced<render::ThroughHierarchy<>, false>(strip, lights, launch);
    case Form::first_occluder:
      return alone ? run_reduced<OnlyInstance, true>(strip, lights, launch)
                   : run_reduced<render::ThroughHierarchy<>, true>(strip, lights, launch);
  }
}

/// The whole film, in strips of `rows`, with gamma if asked for.
template <class Launch>
void run_film(Form form, StripView strip, uint32_t rows, uint32_t lights, bool gamma, const Launch& launch) {
  for (uint32_t row = 0; row < strip.frame.height; row += rows) {
    strip.first = row * strip.frame.width;
    strip.pixels = std::min(rows, strip.frame.height - row) * strip.frame.width;
    run_form(form, strip, lights, launch);
    if (gamma) launch(OverStrip<render::GammaFilm>{strip, {strip.frame}}, 1);
  }
}

}  // namespace kd::bench::paper
