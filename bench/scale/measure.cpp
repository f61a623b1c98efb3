#include "scale/measure.h"

#include <filesystem>

#include "common/console.h"
#include "render/device_group.h"
#include "scene/parse_scene.h"
#include "scene/placed_scene.h"
#include "scene/write_scene.h"
#include "sys/timer.h"

namespace kd::bench::scale {

namespace {

std::vector<Lattice> lattices_of(const render::LoadedScene& loaded) {
  std::vector<Lattice> lattices;
  for (const auto& summary : loaded.summaries) lattices.push_back(summary ? summary->lattice : Lattice{});
  return lattices;
}

/// Seconds of each repeat.
struct Loads {
  std::vector<double> parse, load, place, hierarchy;
};

/// Parses and loads the scene once more; returns it as it was loaded.
Result<render::LoadedScene> load_once(const std::string& file, Loads& loads) {
  Timer timer;
  const auto scene = scene::read_scene(file);
  loads.parse.push_back(timer.lap());
  if (!scene) return scene.error();
  auto loaded = render::load_scene(*scene, {});
  loads.load.push_back(timer.lap());
  if (!loaded) return loaded.error();
  const std::vector<Lattice> lattices = lattices_of(*loaded);
  timer.lap();
  const auto instances = scene::place_instances(*scene, lattices);
  loads.place.push_back(timer.lap());
  if (!instances) return instances.error();
  const auto hierarchy = scene::build_hierarchy(loaded->instances);  // of those that culling left
  loads.hierarchy.push_back(timer.lap());
  return loaded;
}

Result<void> measure_frames(const render::LoadedScene& loaded, const render::Device& device, const Effort& effort,
                            SceneCost& cost) {
  std::vector<double> uploads, frames;
  for (int i = 0; i < effort.repeats; ++i) {
    auto group = render::DeviceGroup::open({device}, false, loaded, {});
    if (!group) return group.error();
    uploads.push_back(group->holding().upload_seconds);
    cost.object_bytes = group->holding().object_bytes;
    cost.scene_bytes = group->holding().scene_bytes;
    if (i + 1 < effort.repeats) continue;
    for (int frame = -effort.warm_ups; frame < effort.repeats; ++frame) {
      auto rendered = group->render(tools::progress_bar("rendering", true));
      if (!rendered) return rendered.error();
      if (frame < 0) continue;
      frames.push_back(rendered->stats.render_seconds);
      cost.primary_hits = rendered->stats.primary_hits;
      cost.shadow_rays = rendered->stats.shadow_rays;
    }
  }
  cost.seconds.upload = median(std::move(uploads));
  cost.seconds.frame = median(std::move(frames));
  return {};
}

}  // namespace

Result<SceneCost> measure_scene(const scene::Scene& scene, const std::string& file, const render::Device& device,
                                const Effort& effort) {
  if (auto written = scene::write_scene(scene, file); !written) return written.error();
  Loads loads;
  for (int i = 1; i < effort.repeats; ++i) {
    if (auto loaded = load_once(file, loads); !loaded) return loaded.error();
  }
  auto loaded = load_once(file, loads);
  if (!loaded) return loaded.error();

  SceneCost cost;
  cost.instances = loaded->instances.size() + loaded->skipped.instances;
  cost.objects_opened = static_cast<uint32_t>(loaded->objects.size());
  cost.seconds.parse = median(std::move(loads.parse));
  cost.seconds.load = median(std::move(loads.load));
  cost.seconds.place = median(std::move(loads.place));
  cost.seconds.hierarchy = median(std::move(loads.hierarchy));
  std::error_code ignored;
  cost.file_bytes = std::filesystem::file_size(file, ignored);
  if (auto measured = measure_frames(*loaded, device, effort, cost); !measured) return measured.error();
  return cost;
}

Result<MotionCost> measure_motion(const scene::Scene& scene, const Effort& effort) {
  const auto loaded = render::load_scene(scene, {});
  if (!loaded) return loaded.error();
  const std::vector<Lattice> lattices = lattices_of(*loaded);
  MotionCost cost;
  std::vector<double> places, moves;
  for (int i = 0; i < effort.repeats; ++i) {
    Timer timer;
    auto placed = scene::PlacedScene::place(scene, lattices, scene::kDefaultFrame);
    if (!placed) return placed.error();
    places.push_back(timer.seconds());
    cost.instances = placed->instances().size();
    if (i + 1 < effort.repeats) continue;
    cost.moves = effort.warm_ups + 2 * effort.repeats;
    for (int move = 1; move <= cost.moves; ++move) {
      timer.lap();
      const auto moved = placed->move_to(scene::kDefaultFrame + move);
      const double seconds = timer.lap();
      if (!moved) return moved.error();
      cost.count = moved->size();
      cost.rebuilds += placed->rebuilt() ? 1 : 0;
      if (move > effort.warm_ups) moves.push_back(seconds);
    }
  }
  cost.place_seconds = median(std::move(places));
  cost.move_seconds = median(std::move(moves));
  return cost;
}

}  // namespace kd::bench::scale
