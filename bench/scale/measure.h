// What a scene costs, step by step from its file to a frame; and what moving a part of it costs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "measure_rays.h"
#include "render/backend.h"
#include "scene/scene.h"

namespace kd::bench::scale {

/// Medians of the repeats, seconds.
struct SceneSeconds {
  double parse = 0;      // the scene file
  double load = 0;       // objects opened, instances placed, what rays can meet validated and under a hierarchy
  double place = 0;      // of that, the instances
  double hierarchy = 0;  // and the hierarchy over them
  double upload = 0;     // objects and instances to the device
  double frame = 0;      // all stages of a later frame
};

struct SceneCost {
  uint64_t count = 0;  // of what the series varies
  uint64_t instances = 0;
  uint32_t objects_opened = 0;
  SceneSeconds seconds;
  uint64_t file_bytes = 0;    // of the scene file
  uint64_t object_bytes = 0;  // on the device
  uint64_t scene_bytes = 0;   // on the device: instances, hierarchy, lights
  uint64_t primary_hits = 0;
  uint64_t shadow_rays = 0;
};

struct MotionCost {
  uint64_t count = 0;  // instances that move
  uint64_t instances = 0;
  double place_seconds = 0;  // all instances, and the hierarchy, from nothing
  double move_seconds = 0;   // from a frame to the next, median
  int moves = 0;
  int rebuilds = 0;  // moves that built the hierarchy again
};

/// Writes the scene to `file` first. Errors as those of parsing, loading and rendering.
Result<SceneCost> measure_scene(const scene::Scene& scene, const std::string& file, const render::Device& device,
                                const Effort& effort);

/// Errors as those of opening objects and placing instances.
Result<MotionCost> measure_motion(const scene::Scene& scene, const Effort& effort);

}  // namespace kd::bench::scale
