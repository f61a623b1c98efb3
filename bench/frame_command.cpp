// kdbench frame: where the time of a frame goes, stage by stage; the first one after an upload, and later ones.
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "commands.h"
#include "common/console.h"
#include "measure_rays.h"
#include "render/device_group.h"
#include "scene/parse_scene.h"
#include "sys/parallel.h"
#include "table.h"

namespace kd::bench {

namespace {

/// Frames before one that counts as a later one.
constexpr int kWarmUps = 10;

struct Options {
  std::string scene, device = "auto";
  unsigned threads = 0;
  int repeats = 9;
  bool gamma = false;
};

using Frames = std::vector<render::RenderStats>;

/// Adds what the next frame of an open scene takes.
Result<void> add_frame(render::DeviceGroup& group, Frames& frames) {
  auto frame = group.render(tools::progress_bar("rendering", true));
  if (!frame) return frame.error();
  frames.push_back(std::move(frame->stats));
  return {};
}

template <class Seconds>
std::string median_ms(const Frames& frames, const Seconds& seconds) {
  std::vector<double> values;
  for (const render::RenderStats& stats : frames) values.push_back(1e3 * seconds(stats));
  return fmt::format("{:.3f}", median(std::move(values)));
}

Table table_of(const Frames& first, const Frames& later) {
  Table table({"stage", "launches", "first frame, ms", "later frames, ms"});
  const auto add = [&](const std::string& name, const std::string& launches, const auto& seconds) {
    table.add({name, launches, median_ms(first, seconds), median_ms(later, seconds)});
  };
  for (size_t i = 0; i < first[0].stages.size(); ++i) {
    const render::StageTime& stage = first[0].stages[i];
    add(stage.stage, fmt::format("{}", stage.launches),
        [i](const render::RenderStats& stats) { return stats.stages[i].seconds; });
  }
  add("all, first launch to last", "", [](const render::RenderStats& stats) { return stats.render_seconds; });
  return table;
}

Result<void> measure(const Options& o) {
  tools::catch_interrupts();
  const ThreadLimit limit(o.threads);
  auto device = render::choose_device(o.device);
  if (!device) return device.error();
  auto scene = scene::read_scene(o.scene);
  if (!scene) return scene.error();
  render::RenderSettings settings;
  settings.gamma_on_film = o.gamma;
  auto loaded = render::load_scene(*scene, settings);
  if (!loaded) return loaded.error();
  fmt::print("{} on {}, {} x {}, medians of {}\n\n", o.scene, device->description, loaded->film.width,
             loaded->film.height, o.repeats);

  Frames first, later;
  for (int i = 0; i < o.repeats; ++i) {
    auto group = render::DeviceGroup::open({*device}, false, *loaded, settings);
    if (!group) return group.error();
    if (auto added = add_frame(*group, first); !added) return added;
    if (i + 1 < o.repeats) continue;
    for (int frame = -kWarmUps; frame < o.repeats; ++frame) {
      if (frame == 0) later.clear();
      if (auto added = add_frame(*group, later); !added) return added;
    }
  }
  fmt::print("{}", table_of(first, later).markdown());
  const render::RenderStats& stats = later.front();
  fmt::print("\n{} primary rays, {} hits, {} shadow rays\n", stats.primary_rays, stats.primary_hits, stats.shadow_rays);
  return {};
}

}  // namespace

Command frame_command(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* c = app.add_subcommand("frame", "Time the stages of a scene's frame");
  c->add_option("scene", o->scene, "A scene file, as kdrender takes it")->required();
  c->add_option("--device", o->device, "auto, cpu, cuda or cuda:N")->capture_default_str();
  c->add_option("--threads", o->threads, "CPU threads; 0: all cores")
      ->check(tools::whole_number(0, 4096))
      ->capture_default_str();
  c->add_option("--repeat", o->repeats, "Frames of each kind; medians are shown")
      ->check(tools::whole_number(1, 10000))
      ->capture_default_str();
  c->add_flag("--gamma-exr", o->gamma, "With gamma on the film, as kdrender has it");
  return {c, [o] {
            const auto done = measure(*o);
            return done ? 0 : tools::fail(kKdbench, done.error());
          }};
}

}  // namespace kd::bench
