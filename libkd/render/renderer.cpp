#include "render/renderer.h"

namespace kd::render {

void RenderStats::add_stage(std::string_view stage, double seconds, uint32_t launches) {
  for (StageTime& known : stages) {
    if (known.stage != stage) continue;
    known.seconds += seconds;
    known.launches += launches;
    return;
  }
  stages.push_back({std::string(stage), seconds, launches});
}

RenderStats& RenderStats::operator+=(const RenderStats& other) {
  render_seconds += other.render_seconds;
  download_seconds += other.download_seconds;
  for (const StageTime& stage : other.stages) add_stage(stage.stage, stage.seconds, stage.launches);
  primary_rays += other.primary_rays;
  primary_hits += other.primary_hits;
  shadow_rays += other.shadow_rays;
  return *this;
}

}  // namespace kd::render
