// The pipeline: which stages run, in which order. Written once; a backend is what launches them.
#pragma once

#include <span>

#include "render/stages/ambient.h"
#include "render/stages/aov.h"
#include "render/stages/average.h"
#include "render/stages/colour.h"
#include "render/stages/count_visits.h"
#include "render/stages/gamma.h"
#include "render/stages/object_intersection.h"
#include "render/stages/ray_generation.h"
#include "render/stages/shadow.h"

namespace kd::render {

struct AovTarget {
  image::Aov aov;
  uint32_t* words;
};

struct PipelinePlan {
  uint32_t light_count = 0;  // lights that are black are not in the scene view
  uint32_t samples = 1;      // a pixel
  std::span<const AovTarget> aovs;
  bool gamma_on_preview = false;
  bool gamma_on_film = false;
  bool one_instance = false;  // is all that the scene places
  bool one_sided = false;     // instances are in it

  /// AOVs are of the pixel's centre, which is none of several samples.
  bool centres_apart() const { return samples > 1 && !aovs.empty(); }
  /// How many rays a pixel sends from the camera.
  uint32_t primary_rays() const { return samples + centres_apart(); }
  /// How many launches there are if some ray hits something.
  size_t launches() const {
    return samples * (1 + max_of(light_count, 1u)) + (samples > 1) + centres_apart() + aovs.size() + gamma_on_preview +
           gamma_on_film;
  }
};

/// What a stage's return values are added up in, where they tell something.
enum Counter : size_t { kHits, kShadowRays, kCounters };
template <class Stage>
constexpr Counter kCounter = kCounters;  // in none
template <class Instances>
constexpr Counter kCounter<ObjectIntersection<Instances>> = kHits;
template <class Instances>
constexpr Counter kCounter<Lighting<Instances>> = kShadowRays;

/// Launches the stages that have work, in order. `launch(stage)` runs stage(pixel) for every pixel and may return
/// before it is done; the next stage starts after it. `launch_and_see(stage)` tells, too, whether such stages returned
/// anything but 0 so far: until a ray hits something, nothing follows that reads a surface.
template <class Launch, class LaunchAndSee>
void run_pipeline(const FrameView& frame, const PipelinePlan& plan, Launch&& launch, LaunchAndSee&& launch_and_see) {
  const auto traced_stages = [&]<class Instances>(Instances) {
    using Shadows = typename Instances::Shadows;
    const auto write_aovs = [&] {
      for (const AovTarget& target : plan.aovs) {
        if (target.aov == image::Aov::visits) {
          launch(CountVisits<Instances>{frame, target.words});
        } else {
          launch(WriteAov{frame, target.aov, target.words});
        }
      }
    };
    if (plan.centres_apart()) {
      launch(CentreIntersection<Instances>{{frame}});
      write_aovs();
    }
    FrameView at = frame;
    at.samples = plan.samples;
    for (at.sample = 0; at.sample < plan.samples; ++at.sample) {
      // Ray generation, intersection, and reduction hit by hit.
      const bool hits = launch_and_see(ObjectIntersection<Instances>{at});
      if (!hits || plan.light_count == 0) launch(Ambient{at});
      for (uint32_t light = 0; light < plan.light_count && hits; ++light) launch(Lighting<Shadows>{at, light});
    }
    if (plan.samples > 1) launch(Average{at});
    if (!plan.centres_apart()) write_aovs();
  };
  with_layout(frame.scene.layout, [&]<TriangleLayout layout>() {
    if (plan.one_sided) {
      traced_stages(ThroughOneSided<layout>{});
    } else if (plan.one_instance) {
      traced_stages(OnlyInstance<layout>{});
    } else {
      traced_stages(ThroughHierarchy<layout>{});
    }
  });
  if (plan.gamma_on_preview) launch(GammaPreview{frame});
  if (plan.gamma_on_film) launch(GammaFilm{frame});
}

}  // namespace kd::render
