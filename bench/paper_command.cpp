// kdbench paper: the pipeline as DiNatale and Kylstra's paper has it, ours, and the steps from one to the other, each
// timed on the same scene.
#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "commands.h"
#include "common/console.h"
#include "common/report.h"
#include "measure_rays.h"
#include "paper/run.h"
#include "render/device_group.h"
#include "render/strip.h"
#include "scene/parse_scene.h"
#include "sys/parallel.h"
#include "table.h"

namespace kd::bench {

namespace {

using tools::Json;

struct Options {
  std::string scene, device = "auto", json;
  unsigned threads = 0;
  int repeats = 9, warm_ups = 10, buffers_mib = 4096;
  bool gamma = false;
};

/// The forms from the paper's to ours, each named for what it changes; after them comes the product.
struct FormRow {
  paper::Form form;
  const char* name;
};
constexpr std::array kForms{FormRow{paper::Form::dense, "the paper's dense form"},
                            FormRow{paper::Form::hit_by_hit, "reduced hit by hit"},
                            FormRow{paper::Form::hierarchy, "a hierarchy over instances"},
                            FormRow{paper::Form::first_occluder, "up to the first occluder, of lights that are faced"}};
constexpr const char* kOurs = "fused stages (ours)";

struct Step {
  const char* name = "";
  paper::Run run;
  uint64_t differing_words = 0;  // of the film, from ours

  double stage_ms(const std::string& stage) const {
    return median_ms([&](const render::RenderStats& stats) {
      double seconds = 0;
      for (const render::StageTime& time : stats.stages) seconds += time.stage == stage ? time.seconds : 0;
      return seconds;
    });
  }
  double all_ms() const {
    return median_ms([](const render::RenderStats& stats) { return stats.render_seconds; });
  }

 private:
  template <class Seconds>
  double median_ms(const Seconds& seconds) const {
    std::vector<double> values;
    for (const render::RenderStats& stats : run.frames) values.push_back(1e3 * seconds(stats));
    return median(std::move(values));
  }
};

Result<paper::Run> run_ours(const Options& o, const render::Device& device, const render::LoadedScene& scene,
                            const render::RenderSettings& settings) {
  auto group = render::DeviceGroup::open({device}, false, scene, settings);
  if (!group) return group.error();
  paper::Run out;
  for (int i = -o.warm_ups; i < o.repeats; ++i) {
    auto frame = group->render(tools::progress_bar("rendering", true));
    if (!frame) return frame.error();
    if (i < 0) continue;
    out.frames.push_back(std::move(frame->stats));
    out.film = std::move(frame->film.colour);
  }
  out.strips = group->strips();
  out.frame_bytes = size_t{scene.film.width} * scene.film.height * render::bytes_a_pixel(settings);
  out.undivided_bytes = out.frame_bytes;
  return out;
}

uint64_t words_that_differ(const std::vector<float>& a, const std::vector<float>& b) {
  uint64_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) count += std::memcmp(&a[i], &b[i], sizeof(float)) != 0;
  return count;
}

Result<std::vector<Step>> run_steps(const Options& o, const render::Device& device, const render::LoadedScene& scene,
                                    const render::RenderSettings& settings) {
  std::vector<Step> steps;
  for (const FormRow& row : kForms) {
    const paper::Job job{row.form, static_cast<uint64_t>(o.buffers_mib) << 20, o.warm_ups, o.repeats,
                         tools::progress_bar("rendering", true)};
    auto run = device.backend->name == "cuda" ? paper::run_on_cuda(scene, settings, job, device.index)
                                              : paper::run_on_cpu(scene, settings, job);
    if (!run) return run.error();
    steps.push_back({row.name, std::move(*run)});
  }
  auto ours = run_ours(o, device, scene, settings);
  if (!ours) return ours.error();
  steps.push_back({kOurs, std::move(*ours)});
  for (Step& step : steps) step.differing_words = words_that_differ(step.run.film, steps.back().run.film);
  return steps;
}

/// Every stage that some step has, in the order of the paper's.
std::vector<std::string> stages_of(const std::vector<Step>& steps) {
  std::vector<std::string> stages;
  for (const Step& step : steps) {
    for (const render::StageTime& time : step.run.frames.front().stages) {
      if (std::find(stages.begin(), stages.end(), time.stage) == stages.end()) stages.push_back(time.stage);
    }
  }
  return stages;
}

std::string ms_or_dash(double ms) { return ms > 0 ? fmt::format("{:.3f}", ms) : "-"; }

std::string mebibytes(uint64_t bytes) { return fmt::format("{:.1f}", static_cast<double>(bytes) / (1 << 20)); }

Table steps_table(const std::vector<Step>& steps) {
  Table table({"step", "ms", "gain", "of the dense form", "MiB", "strips", "MiB undivided", "film"});
  for (size_t i = 0; i < steps.size(); ++i) {
    const Step& step = steps[i];
    const auto times = [&](const Step& from) { return fmt::format("{:.2f} x", from.all_ms() / step.all_ms()); };
    table.add({step.name, fmt::format("{:.3f}", step.all_ms()), i == 0 ? "" : times(steps[i - 1]), times(steps[0]),
               mebibytes(step.run.frame_bytes), fmt::format("{}", step.run.strips), mebibytes(step.run.undivided_bytes),
               step.differing_words == 0 ? "identical" : fmt::format("{} words differ", step.differing_words)});
  }
  return table;
}

/// A column a step.
Table stages_table(const std::vector<Step>& steps) {
  Table table({"stage, ms", "dense", "hit by hit", "hierarchy", "first occluder", "ours"});
  const auto add = [&](const std::string& name, const auto& ms) {
    std::vector<std::string> cells{name};
    for (const Step& step : steps) cells.push_back(ms_or_dash(ms(step)));
    table.add(std::move(cells));
  };
  for (const std::string& stage : stages_of(steps)) add(stage, [&](const Step& step) { return step.stage_ms(stage); });
  add("all, first launch to last", [](const Step& step) { return step.all_ms(); });
  return table;
}

void print_verdict(const std::vector<Step>& steps) {
  uint64_t differing = 0;
  for (const Step& step : steps) differing += step.differing_words;
  if (differing == 0) {
    fmt::print("\nfilm: identical\n");
  } else {
    fmt::print("\nfilm: {} words differ from ours, of {} in each step\n", differing, steps.back().run.film.size());
  }
}

Json report_json(const Options& o, const render::Device& device, const render::LoadedScene& scene,
                 const std::vector<Step>& steps) {
  Json j{{"version", 1},
         {"tool", tools::version_text()},
         {"scene", o.scene},
         {"device", device.description},
         {"width", scene.film.width},
         {"height", scene.film.height},
         {"instances", scene.instances.size()},
         {"lights", scene.lights.size()},
         {"warm_ups", o.warm_ups},
         {"repeats", o.repeats}};
  for (const Step& step : steps) {
    Json row{{"step", step.name},
             {"milliseconds", step.all_ms()},
             {"frame_bytes", step.run.frame_bytes},
             {"strips", step.run.strips},
             {"undivided_bytes", step.run.undivided_bytes},
             {"differing_words", step.differing_words}};
    for (const render::StageTime& time : step.run.frames.front().stages) {
      row["stages"].push_back(
          {{"stage", time.stage}, {"launches", time.launches}, {"milliseconds", step.stage_ms(time.stage)}});
    }
    j["steps"].push_back(std::move(row));
  }
  return j;
}

Result<void> measure(const Options& o) {
  tools::catch_interrupts();
  const ThreadLimit limit(o.threads);
  if (auto usable = tools::check_outputs({o.json}, {o.scene}); !usable) return usable;
  auto device = render::choose_device(o.device);
  if (!device) return device.error();
  auto scene = scene::read_scene(o.scene);
  if (!scene) return scene.error();
  render::RenderSettings settings;
  settings.gamma_on_film = o.gamma;
  auto loaded =
      render::load_scene(*scene, settings, render::kStill, render::Extent::all);  // the paper leaves nothing out
  if (!loaded) return loaded.error();
  if (loaded->instances.empty()) return Error{ErrorClass::scene, o.scene, "it places no object: nothing to measure"};
  if (o.json != "-") {
    fmt::print("{} on {}, {} x {}, {} instances, {} lights, medians of {}\n\n", o.scene, device->description,
               loaded->film.width, loaded->film.height, loaded->instances.size(), loaded->lights.size(), o.repeats);
  }

  auto steps = run_steps(o, *device, *loaded, settings);
  if (!steps) return steps.error();
  if (o.json != "-") {
    fmt::print("{}\n{}", steps_table(*steps).markdown(), stages_table(*steps).markdown());
    print_verdict(*steps);
  }
  if (o.json.empty()) return {};
  return tools::write_report(o.json, report_json(o, *device, *loaded, *steps));
}

}  // namespace

Command paper_command(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* c = app.add_subcommand("paper", "Time a scene's frame as the paper has it, as ours, and the steps between");
  c->add_option("scene", o->scene, "A scene file, as kdrender takes it")->required();
  c->add_option("--device", o->device, "auto, cpu, cuda or cuda:N")->capture_default_str();
  c->add_option("--threads", o->threads, "CPU threads; 0: all cores")
      ->check(tools::whole_number(0, 4096))
      ->capture_default_str();
  c->add_option("--repeat", o->repeats, "Timed frames of each step; medians are shown")
      ->check(tools::whole_number(1, 10000))
      ->capture_default_str();
  c->add_option("--warm-up", o->warm_ups, "Untimed frames before them")
      ->check(tools::whole_number(0, 1000))
      ->capture_default_str();
  c->add_option("--buffers", o->buffers_mib, "MiB for a strip's buffers: where a film takes more, it is done in strips")
      ->check(tools::whole_number(1, 1 << 20))
      ->capture_default_str();
  c->add_flag("--gamma-exr", o->gamma, "With gamma on the film, as kdrender has it");
  c->add_option("--json", o->json, "Write a JSON report to this file, or to stdout (-)");
  return {c, [o] {
            const auto done = measure(*o);
            return done ? 0 : tools::fail(kKdbench, done.error());
          }};
}

}  // namespace kd::bench
