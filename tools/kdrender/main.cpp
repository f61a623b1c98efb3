// kdrender: renders a scene file to OpenEXR, and a PNG to look at.
#include <fmt/format.h>

#include "common/console.h"
#include "common/report.h"
#include "image/exr.h"
#include "image/png.h"
#include "kdrender/render_report.h"
#include "render/device_group.h"
#include "scene/parse_scene.h"
#include "sys/parallel.h"
#include "sys/timer.h"

namespace {

using namespace kd;
using namespace kd::tools;

constexpr const char* kKdrender = "kdrender";

struct Options {
  std::string scene, output, preview, stats, aovs;
  std::string device = "auto";
  uint32_t samples = 1;
  double gamma = 2.2;
  bool gamma_on_exr = false;
  unsigned threads = 0;
  bool quiet = false;
};

void add_options(CLI::App& app, Options& o) {
  std::string aov_help = "AOVs to write as further channels, separated by commas:";
  for (const image::AovRow& row : image::kAovRows) aov_help += fmt::format(" {}", row.name);
  app.add_option("scene", o.scene, "Scene file (JSON, see schema/scene.fbs)")->required();
  app.add_option("-o,--output", o.output, "The EXR to write: R, G, B, A and AOVs, scene-linear")
      ->required()
      ->check(file_name());
  app.add_option("--preview", o.preview, "Write an 8-bit PNG too, through the gamma stage");
  app.add_option("--device", o.device, "auto, cpu, cuda, cuda:N, cuda:all, or a list of these")->capture_default_str();
  app.add_option("--aov", o.aovs, aov_help);
  app.add_option("--spp", o.samples, "Samples a pixel, under a tent filter; 1: its centre")
      ->check(whole_number(1, render::kMaxSamples))
      ->capture_default_str();
  app.add_option("--gamma", o.gamma, "Gamma of the preview")->check(number(0.1, 10))->capture_default_str();
  app.add_flag("--gamma-exr", o.gamma_on_exr, "Apply the gamma to the EXR as well; its header then says so");
  app.add_option("--stats", o.stats, "Write a JSON report to this file, or to stdout (-)");
  app.add_option("--threads", o.threads, "CPU threads to use; 0: all cores")
      ->check(whole_number(0, 4096))
      ->capture_default_str();
  app.add_flag("--quiet", o.quiet, "Print nothing but errors");
}

std::vector<std::string> inputs_of(const Options& o, const scene::Scene& scene) {
  std::vector<std::string> inputs{o.scene};
  for (const scene::SceneObject& object : scene.objects) inputs.push_back(object.file);
  return inputs;
}

Result<void> write_images(const Options& o, const render::Frame& frame) {
  image::ExrHeader header;
  header.software = version_text();
  if (o.gamma_on_exr) header.gamma = o.gamma;
  if (auto written = image::write_exr(o.output, frame.film, header); !written) return written;
  if (o.preview.empty()) return {};
  return image::write_png(o.preview, frame.film.width, frame.film.height, frame.preview);
}

Result<void> render_scene(const Options& o) {
  const ThreadLimit limit(o.threads);
  auto aovs = image::parse_aovs(o.aovs);
  if (!aovs) return aovs.error();
  auto devices = render::choose_devices(o.device);
  if (!devices) return devices.error();

  RenderTimes times;
  Timer timer;
  auto scene = scene::read_scene(o.scene);
  if (!scene) return scene.error();
  times.parse = timer.lap();
  if (auto usable = check_outputs({o.output, o.preview, o.stats}, inputs_of(o, *scene)); !usable) return usable;
  catch_interrupts();
  const Progress progress = progress_bar("rendering", o.quiet);
  const render::RenderSettings settings{*aovs, o.samples, !o.preview.empty(), o.gamma, o.gamma_on_exr};
  auto loaded = render::load_scene(*scene, settings);
  if (!loaded) return loaded.error();
  times.load = timer.lap();

  const bool text = !o.quiet && o.stats != "-";
  if (text) {
    const std::string& reason = devices->front().reason;
    fmt::print("{}: on {}{}\n", o.scene, described(*devices), reason.empty() ? "" : fmt::format(" ({})", reason));
  }
  auto group = render::DeviceGroup::open(*devices, o.device == "auto", *loaded, settings);
  if (!group) return group.error();
  auto frame = group->render(progress);
  keep_going(progress, 1);
  if (!frame) return frame.error();
  if (!group->taken_over().empty()) warn(kKdrender, group->taken_over() + "; the CPU took over");
  timer.lap();
  if (auto written = write_images(o, *frame); !written) return written;
  times.write = timer.lap();

  if (text) print_render(o.output, *group, *loaded, frame->stats, times);
  if (o.stats.empty()) return {};
  return write_report(o.stats, render_json(o.scene, o.output, *group, *loaded, frame->stats, times));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Renders a scene of .nkd objects to OpenEXR, on CUDA or on the CPU.", kKdrender);
  Options options;
  add_options(app, options);
  return run_tool(app, argc, argv, [&] {
    const auto rendered = render_scene(options);
    return rendered ? 0 : fail(kKdrender, rendered.error());
  });
}
