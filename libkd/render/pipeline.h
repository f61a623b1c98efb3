// The pipeline: which stages run, in which order. Written once; a backend is what launches them.
#pragma once

#include <span>

#include "render/stages/ambient.h"
#include "render/stages/aov.h"
#include "render/stages/colour.h"
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
  std::span<const AovTarget> aovs;
  bool gamma_on_preview = false;
  bool gamma_on_film = false;
};

/// Launches the stages in order. `launch(stage)` runs stage(pixel) for every pixel and may return before it is done;
/// the next stage starts after it.
template <class Launch>
void run_pipeline(const FrameView& frame, const PipelinePlan& plan, Launch&& launch) {
  launch(RayGeneration{frame});
  launch(ObjectIntersection{frame});  // and intersection reduction, hit by hit
  launch(Ambient{frame});
  for (uint32_t light = 0; light < plan.light_count; ++light) {
    launch(Shadow{frame, light});
    launch(Colour{frame, light});
  }
  for (const AovTarget& target : plan.aovs) launch(WriteAov{frame, target.aov, target.words});
  if (plan.gamma_on_preview) launch(GammaPreview{frame});
  if (plan.gamma_on_film) launch(GammaFilm{frame});
}

}  // namespace kd::render
