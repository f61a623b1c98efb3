// kdrender: renders a scene file to OpenEXR, and pictures to look at.
#include <algorithm>

#include <fmt/format.h>

#include "common/console.h"
#include "common/report.h"
#include "image/compare.h"
#include "image/exr.h"
#include "image/heatmap.h"
#include "image/png.h"
#include "kdrender/options.h"
#include "kdrender/render_report.h"
#include "render/device_group.h"
#include "scene/parse_scene.h"
#include "sys/parallel.h"
#include "sys/timer.h"

namespace {

using namespace kd;
using namespace kd::tools;

constexpr const char* kKdrender = "kdrender";

std::vector<std::string> inputs_of(const RenderOptions& o, const scene::Scene& scene) {
  std::vector<std::string> inputs{o.scene, o.reference};
  for (const scene::SceneObject& object : scene.objects) inputs.push_back(object.file);
  return inputs;
}

Result<render::RenderSettings> settings_of(const RenderOptions& o, const scene::FilmSize& film) {
  render::RenderSettings settings;
  auto aovs = image::parse_aovs(o.aovs);
  if (!aovs) return aovs.error();
  settings.aovs = std::move(*aovs);
  const bool visits_asked =
      std::find(settings.aovs.begin(), settings.aovs.end(), image::Aov::visits) != settings.aovs.end();
  if (!o.heatmap.empty() && !visits_asked) settings.aovs.push_back(image::Aov::visits);
  settings.samples = o.samples;
  settings.preview = !o.preview.empty();
  settings.gamma = o.gamma;
  settings.gamma_on_film = o.gamma_on_exr;
  if (!o.crop.empty()) {
    auto crop = parse_crop(o.crop, film);
    if (!crop) return crop.error();
    settings.crop = *crop;
  }
  return settings;
}

/// Takes the visits out of the film unless they are one of its AOVs.
Result<void> write_heatmap(const RenderOptions& o, image::Film& film) {
  const auto visits = std::find_if(film.aovs.begin(), film.aovs.end(),
                                   [](const image::AovBuffer& buffer) { return buffer.aov == image::Aov::visits; });
  const uint32_t most = image::most_visits(*visits);
  auto written = image::write_png(o.heatmap, film.width, film.height, image::heatmap(*visits, most));
  if (written && !o.quiet && o.stats != "-") fmt::print("{}: up to {} visits a ray\n", o.heatmap, most);
  const auto asked = *image::parse_aovs(o.aovs);
  if (std::find(asked.begin(), asked.end(), image::Aov::visits) == asked.end()) film.aovs.erase(visits);
  return written;
}

Result<void> write_images(const RenderOptions& o, render::Frame& frame) {
  image::ExrHeader header;
  header.software = version_text();
  if (o.gamma_on_exr) header.gamma = o.gamma;
  if (!o.heatmap.empty()) {
    if (auto written = write_heatmap(o, frame.film); !written) return written;
  }
  if (!o.output.empty()) {
    if (auto written = image::write_exr(o.output, frame.film, header); !written) return written;
  }
  if (o.preview.empty()) return {};
  return image::write_png(o.preview, frame.film.width, frame.film.height, frame.preview);
}

Result<void> compare(const RenderOptions& o, const image::Film& film) {
  const auto reference = image::read_exr_colour(o.reference);
  if (!reference) return reference.error();
  if (reference->width != film.width || reference->height != film.height) {
    return Error{ErrorClass::differs, o.reference,
                 fmt::format("it has {} x {} pixels, the film {} x {}", reference->width, reference->height, film.width,
                             film.height)};
  }
  const image::Difference difference = image::compare_colour(film, *reference);
  const std::string text = fmt::format("{} pixels differ, by up to {:.6g}, RMSE {:.6g}", difference.pixels,
                                       difference.largest, difference.rmse);
  if (difference.largest > o.threshold) {
    return Error{ErrorClass::differs, o.reference, fmt::format("{}; {:.6g} may be", text, o.threshold)};
  }
  if (!o.quiet && o.stats != "-") fmt::print("{}: {}\n", o.reference, text);
  return {};
}

Result<void> render_scene(const RenderOptions& o) {
  const ThreadLimit limit(o.threads);
  RenderTimes times;
  Timer timer;
  auto scene = scene::read_scene(o.scene);
  if (!scene) return scene.error();
  times.parse = timer.lap();
  if (!o.size.empty()) {
    auto size = parse_size(o.size);
    if (!size) return size.error();
    scene->film = *size;
  }
  const auto settings = settings_of(o, scene->film);
  if (!settings) return settings.error();
  const std::vector<std::string> outputs{o.output, o.preview, o.heatmap, o.stats};
  if (auto usable = check_outputs(outputs, inputs_of(o, *scene)); !usable) return usable;
  catch_interrupts();
  const Progress progress = progress_bar("rendering", o.quiet);
  const bool text = !o.quiet && o.stats != "-";
  if (o.check) {
    auto loaded = render::load_scene(*scene, *settings);
    if (!loaded) return loaded.error();
    if (text) print_contents(o.scene, *loaded);
    return {};
  }

  auto devices = render::choose_devices(o.device);
  if (!devices) return devices.error();
  timer.lap();
  auto loaded = render::load_scene(*scene, *settings);
  if (!loaded) return loaded.error();
  times.load = timer.lap();
  if (text) {
    const std::string& reason = devices->front().reason;
    fmt::print("{}: on {}{}\n", o.scene, described(*devices), reason.empty() ? "" : fmt::format(" ({})", reason));
  }
  auto group = render::DeviceGroup::open(*devices, o.device == "auto", *loaded, *settings);
  if (!group) return group.error();
  auto frame = group->render(progress);
  keep_going(progress, 1);
  if (!frame) return frame.error();
  if (!group->taken_over().empty()) warn(kKdrender, group->taken_over() + "; the CPU took over");
  timer.lap();
  if (auto written = write_images(o, *frame); !written) return written;
  times.write = timer.lap();

  if (text) print_render(o.output, *group, *loaded, frame->stats, times);
  if (!o.stats.empty()) {
    const Json report = render_json(o.scene, o.output, *group, *loaded, frame->stats, times);
    if (auto written = write_report(o.stats, report); !written) return written;
  }
  return o.reference.empty() ? Result<void>() : compare(o, frame->film);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Renders a scene of .nkd objects to OpenEXR, on CUDA or on the CPU.", kKdrender);
  RenderOptions options;
  add_options(app, options);
  return run_tool(app, argc, argv, [&] {
    if (options.output.empty() && options.heatmap.empty() && options.reference.empty() && !options.check) {
      return fail(kKdrender, {ErrorClass::usage, "", "--output is required, or --check, --compare or --heatmap"});
    }
    const auto rendered = render_scene(options);
    return rendered ? 0 : fail(kKdrender, rendered.error());
  });
}
