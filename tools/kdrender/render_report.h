// What kdrender tells of a render: as text, and as JSON for --stats (schema/kdrender-stats.schema.json).
#pragma once

#include "common/report.h"
#include "render/device_group.h"

namespace kd::tools {

struct RenderTimes {
  double parse = 0;
  double load = 0;  // opening, validating, placing
  double write = 0;
};

Json render_json(const std::string& scene_path, const std::string& output, const render::DeviceGroup& group,
                 const render::LoadedScene& scene, const render::RenderStats& stats, const RenderTimes& times);

void print_render(const std::string& output, const render::DeviceGroup& group, const render::LoadedScene& scene,
                  const render::RenderStats& stats, const RenderTimes& times);

/// What --check found.
void print_contents(const std::string& scene_path, const render::LoadedScene& scene);

/// The group's devices by name.
std::string described(const std::vector<render::Device>& devices);

}  // namespace kd::tools
