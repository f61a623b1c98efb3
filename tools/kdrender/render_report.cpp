#include "kdrender/render_report.h"

#include <algorithm>

#include <fmt/format.h>

#include "common/console.h"

namespace kd::tools {

namespace {

/// As if every instance had triangles of its own.
uint64_t instanced_triangles(const render::LoadedScene& scene) {
  uint64_t total = 0;
  for (const scene::Instance& instance : scene.instances) {
    total += scene.objects[scene.object_slots[instance.object]].file.geometry().triangle_count();
  }
  return total;
}

double mrays_per_second(const render::RenderStats& stats) {
  return static_cast<double>(stats.primary_rays + stats.shadow_rays) / std::max(stats.render_seconds, 1e-9) * 1e-6;
}

}  // namespace

std::string described(const std::vector<render::Device>& devices) {
  std::string text;
  for (const render::Device& device : devices) text += (text.empty() ? "" : ", ") + device.description;
  return text;
}

Json render_json(const std::string& scene_path, const std::string& output, const render::DeviceGroup& group,
                 const render::LoadedScene& scene, const render::RenderStats& stats, const RenderTimes& times) {
  Json stages = Json::array();
  for (const render::StageTime& stage : stats.stages) {
    stages.push_back({{"stage", stage.stage}, {"launches", stage.launches}, {"seconds", stage.seconds}});
  }
  Json objects = Json::array();
  for (const render::LoadedObject& object : scene.objects) {
    objects.push_back({{"file", object.file.path()},
                       {"triangles", object.file.geometry().triangle_count()},
                       {"sah_cost", object.file.summary().tree.sah_cost},
                       {"max_displacement", object.file.summary().max_displacement}});
  }
  const render::Skipped& skipped = scene.skipped;
  const render::Holding holding = group.holding();
  return {
      {"version", 1},
      {"tool", version_text()},
      {"scene", scene_path},
      {"output", output},
      {"device",
       {{"backend", group.devices().front().backend->name},
        {"description", described(group.devices())},
        {"reason", group.devices().front().reason},
        {"layout", kd::name_of(holding.layout)},
        {"strips", group.strips()}}},
      {"film", {{"width", scene.film.width}, {"height", scene.film.height}}},
      {"seconds",
       {{"parse", times.parse},
        {"load", times.load},
        {"upload", holding.upload_seconds},
        {"stages", stats.render_seconds},
        {"download", stats.download_seconds},
        {"write", times.write}}},
      {"stages", stages},
      {"counts",
       {{"objects", scene.objects.size()},
        {"instances", scene.instances.size()},
        {"triangles_as_seen", instanced_triangles(scene)},
        {"lights", scene.lights.size()}}},
      {"rays", {{"primary", stats.primary_rays}, {"primary_hits", stats.primary_hits}, {"shadow", stats.shadow_rays}}},
      {"mrays_per_second", mrays_per_second(stats)},
      {"bytes",
       {{"objects", holding.object_bytes},
        {"scene", holding.scene_bytes},
        {"frame", holding.strip_bytes},
        {"device", holding.device_bytes}}},
      {"objects", objects},
      {"skipped",
       {{"objects_not_opened", skipped.objects},
        {"objects_not_loaded", skipped.unmet_objects},
        {"instances_not_loaded", skipped.instances},
        {"sections_not_read", skipped.sections},
        {"black_lights", skipped.black_lights},
        {"lights_out_of_reach", skipped.lights_out_of_reach},
        {"shadow_launches",
         skipped.black_lights + skipped.lights_out_of_reach + (stats.primary_hits == 0 ? scene.lights.size() : 0)},
        {"shadow_rays", stats.primary_hits * scene.lights.size() - stats.shadow_rays},
        {"aov_buffers", skipped.aov_buffers}}},
  };
}

void print_contents(const std::string& scene_path, const render::LoadedScene& scene) {
  fmt::print("{}: sound: {} objects, {} instances, {} triangles as seen, {} lights, {} x {} pixels\n", scene_path,
             scene.objects.size(), scene.instances.size(), instanced_triangles(scene), scene.lights.size(),
             scene.film.width, scene.film.height);
}

void print_render(const std::string& output, const render::DeviceGroup& group, const render::LoadedScene& scene,
                  const render::RenderStats& stats, const RenderTimes& times) {
  const render::Holding holding = group.holding();
  fmt::print("  {} objects, {} instances, {} triangles as seen, {} lights; {} objects and {} instances not needed\n",
             scene.objects.size(), scene.instances.size(), instanced_triangles(scene), scene.lights.size(),
             scene.skipped.objects + scene.skipped.unmet_objects, scene.skipped.instances);
  fmt::print("  {} primary rays ({} hit), {} shadow rays ({} not needed): {:.2f} Mrays/s{}\n", stats.primary_rays,
             stats.primary_hits, stats.shadow_rays, stats.primary_hits * scene.lights.size() - stats.shadow_rays,
             mrays_per_second(stats), group.strips() > 1 ? fmt::format(", in {} strips", group.strips()) : "");
  fmt::print(
      "  load {:.3f} s, upload {:.3f} s, stages {:.4f} s, download {:.4f} s, write {:.3f} s; {:.1f} MiB of objects on "
      "the device{}\n",
      times.load, holding.upload_seconds, stats.render_seconds, stats.download_seconds, times.write,
      static_cast<double>(holding.object_bytes) / (1 << 20),
      holding.layout == TriangleLayout::compact ? ", compact" : "");
  if (!output.empty()) fmt::print("{}: {} x {}\n", output, scene.window.width, scene.window.height);
}

}  // namespace kd::tools
