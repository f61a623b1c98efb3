// Adds up the time of each stage over its launches.
#pragma once

#include <string_view>

#include "render/backend.h"

namespace kd::render {

inline void add_stage_time(RenderStats& stats, std::string_view stage, double seconds) {
  for (StageTime& known : stats.stages) {
    if (known.stage != stage) continue;
    known.seconds += seconds;
    ++known.launches;
    return;
  }
  stats.stages.push_back({std::string(stage), seconds, 1});
}

}  // namespace kd::render
