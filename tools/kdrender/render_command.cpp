#include "kdrender/render_command.h"

#include <cstdio>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "common/console.h"
#include "common/report.h"
#include "kdrender/exr_header.h"
#include "kdrender/frames.h"
#include "kdrender/outputs.h"
#include "kdrender/render_report.h"
#include "scene/parse_scene.h"
#include "sys/hash.h"
#include "sys/mapped_file.h"
#include "sys/parallel.h"
#include "sys/timer.h"

namespace kd::tools {

namespace {

/// The options with one frame's names; those of a still are as they are.
RenderOptions of_frame(RenderOptions o, int frame) {
  if (o.frames.empty()) return o;
  for (std::string* name : {&o.output, &o.preview, &o.heatmap, &o.stats, &o.reference}) *name = numbered(*name, frame);
  return o;
}

/// Every frame needs names of its own.
Result<void> check_names(const RenderOptions& o, size_t frames) {
  if (o.output.empty() && o.heatmap.empty() && o.reference.empty() && !o.check) {
    return Error{ErrorClass::usage, "", "--output is required, or --check, --compare or --heatmap"};
  }
  if (o.resume && o.output.empty()) return Error{ErrorClass::usage, "--resume", "there is no --output to look for"};
  if (o.resume && !o.reference.empty()) {
    return Error{ErrorClass::usage, "--resume", "frames that are left out would not be compared: leave out --compare"};
  }
  if (o.check && !o.stats.empty())
    return Error{ErrorClass::usage, "--check", "it renders nothing to report in --stats"};
  for (const std::string* name : {&o.output, &o.preview, &o.heatmap, &o.stats, &o.reference}) {
    if (frames > 1 && !name->empty() && !is_numbered(*name)) {
      return Error{ErrorClass::usage, *name, "several frames would share it: name it like x.####.exr"};
    }
  }
  return {};
}

std::vector<std::string> inputs_of(const RenderOptions& o, const scene::Scene& scene) {
  std::vector<std::string> inputs{o.scene, o.reference};
  for (const scene::SceneObject& object : scene.objects) inputs.push_back(object.file);
  return inputs;
}

Result<scene::Scene> read_scene(const RenderOptions& o) {
  std::vector<scene::Override> overrides;
  for (const std::string& text : o.overrides) {
    auto parsed = scene::parse_override(text);
    if (!parsed) return parsed.error();
    overrides.push_back(std::move(*parsed));
  }
  auto scene = scene::read_scene(o.scene, overrides);
  if (!scene || o.size.empty()) return scene;
  auto size = parse_size(o.size);
  if (!size) return size.error();
  scene->film = *size;
  return scene;
}

/// Of the scene's text and what --set makes of it.
Result<std::string> scene_hash(const RenderOptions& o) {
  auto file = MappedFile::open(o.scene);
  if (!file) return file.error();
  uint64_t hash = hash_bytes(file->bytes().data(), file->bytes().size());
  for (const std::string& text : o.overrides) hash = hash_bytes(text.data(), text.size()) ^ (hash * 31);
  return hash_text(hash);
}

/// What became of a frame's files.
struct Written {
  double seconds = 0;
  uint32_t most_visits = 0;
  std::string comparison;
};

Result<Written> write(const RenderOptions& o, render::Frame& frame, const FrameNotes& notes, Json& report) {
  Timer timer;
  const auto most_visits = write_images(o, frame, notes);
  if (!most_visits) return most_visits.error();
  Written written{timer.seconds(), *most_visits, {}};
  if (!o.stats.empty()) {
    report["seconds"]["write"] = written.seconds;
    if (auto reported = write_report(o.stats, report); !reported) return reported.error();
  }
  if (o.reference.empty()) return written;
  auto comparison = compare(o, frame.film);
  if (!comparison) return comparison.error();
  written.comparison = std::move(*comparison);
  return written;
}

/// Frames of one scene, one after the other: each is written while the next one is rendered.
class FrameLoop {
 public:
  FrameLoop(const RenderOptions& o, const scene::Scene& scene, const render::RenderSettings& settings,
            std::string scene_hash, double parse_seconds)
      : o_(o), scene_(scene), settings_(settings), scene_hash_(std::move(scene_hash)) {
    times_.parse = parse_seconds;
  }

  Result<void> render(const std::vector<int>& frames, const std::vector<render::Device>& devices);

 private:
  /// A frame on its way to disk.
  struct Writing {
    RenderOptions o;
    render::Frame frame;
    FrameNotes notes;
    Json report;
    std::future<Result<Written>> done;
  };

  Result<void> stand_at(int frame, const std::vector<int>& frames, const std::vector<render::Device>& devices);
  Result<void> start_writing(const RenderOptions& o, render::Frame frame, FrameNotes notes);
  Result<void> finish_writing();

  const RenderOptions& o_;
  const scene::Scene& scene_;
  const render::RenderSettings& settings_;
  std::string scene_hash_;
  RenderTimes times_;
  bool several_ = false;
  bool warned_ = false;
  std::optional<render::LoadedScene> loaded_;
  std::optional<render::DeviceGroup> group_;
  std::unique_ptr<Writing> writing_;
};

/// Loads the scene for all frames, or moves it and its devices.
Result<void> FrameLoop::stand_at(int frame, const std::vector<int>& frames,
                                 const std::vector<render::Device>& devices) {
  Timer timer;
  if (loaded_) {
    const auto moved = render::move_to(*loaded_, scene_, frame);
    if (!moved) return moved.error();
    auto followed = group_->follow(*moved);
    times_.parse = 0;  // was told with the first frame
    times_.load = timer.seconds();
    return followed;
  }
  auto loaded = render::load_scene(scene_, settings_, std::vector<double>(frames.begin(), frames.end()),
                                   render::Extent::met, render::Checking::going_on);
  if (!loaded) return loaded.error();
  loaded_.emplace(std::move(*loaded));
  times_.load = timer.seconds();
  auto group = render::DeviceGroup::open(devices, o_.device == "auto", *loaded_, settings_);
  if (!group) return group.error();
  group_ = std::move(*group);
  return {};
}

Result<void> FrameLoop::start_writing(const RenderOptions& o, render::Frame frame, FrameNotes notes) {
  if (auto finished = finish_writing(); !finished) return finished;
  Json report = render_json(o_.scene, o.output, *group_, *loaded_, frame.stats, times_);
  writing_ = std::make_unique<Writing>(o, std::move(frame), std::move(notes), std::move(report));
  writing_->done =
      std::async(std::launch::async, [w = writing_.get()] { return write(w->o, w->frame, w->notes, w->report); });
  return {};
}

Result<void> FrameLoop::finish_writing() {
  if (!writing_) return {};
  const std::unique_ptr<Writing> ended = std::move(writing_);
  const auto written = ended->done.get();
  if (!written) return written.error();
  const RenderOptions& o = ended->o;
  if (o.quiet || o.stats == "-") return {};
  if (several_) {
    fmt::print("{}: frame {}, {:.4f} s\n", o.output.empty() ? o.scene : o.output, ended->notes.frame,
               ended->frame.stats.render_seconds);
  } else {
    times_.write = written->seconds;
    print_render(o.output, *group_, *loaded_, ended->frame.stats, times_);
  }
  if (!o.heatmap.empty()) fmt::print("{}: up to {} visits a ray\n", o.heatmap, written->most_visits);
  if (!o.reference.empty()) fmt::print("{}: {}\n", o.reference, written->comparison);
  std::fflush(stdout);
  return {};
}

Result<void> FrameLoop::render(const std::vector<int>& frames, const std::vector<render::Device>& devices) {
  several_ = frames.size() > 1;
  std::string objects;
  size_t skipped = 0;
  for (size_t i = 0; i < frames.size(); ++i) {
    const int number = frames[i];
    const RenderOptions o = of_frame(o_, number);
    if (o.resume && !objects.empty() && is_done(o, fingerprint(o, scene_hash_, objects, number))) {
      ++skipped;
      continue;
    }
    if (auto stands = stand_at(number, frames, devices); !stands) return stands;
    if (objects.empty()) objects = objects_hash(*loaded_);
    const std::string mark = fingerprint(o, scene_hash_, objects, number);
    if (o.resume && is_done(o, mark)) {  // only now, for the first: the objects had to be opened for their hash
      ++skipped;
      continue;
    }
    const std::string label = several_ ? fmt::format("frame {}, {} of {}", number, i + 1, frames.size()) : "rendering";
    const Progress progress = progress_bar(label, o.quiet);
    auto frame = group_->render(progress);
    keep_going(progress, 1);
    if (!frame) return frame.error();
    if (!group_->taken_over().empty() && !warned_) {
      warn(kKdrender, group_->taken_over() + "; the CPU took over");
      warned_ = true;
    }
    const auto camera = scene::camera_at(scene_, number);
    if (!camera) return camera.error();
    const double seconds = frame->stats.render_seconds;
    FrameNotes notes{*camera, loaded_->film, scene_hash_, objects, mark, described(group_->devices()), number, seconds};
    if (auto started = start_writing(o, std::move(*frame), std::move(notes)); !started) return started;
  }
  auto finished = finish_writing();
  if (finished && skipped > 0 && !o_.quiet && o_.stats != "-") fmt::print("{} frames were there already\n", skipped);
  return finished;
}

}  // namespace

Result<void> render_command(const RenderOptions& o) {
  const ThreadLimit limit(o.threads);
  const auto frames = parse_frames(o.frames.empty() ? "1" : o.frames);
  if (!frames) return frames.error();
  if (auto named = check_names(o, frames->size()); !named) return named;
  Timer timer;
  const auto scene = read_scene(o);
  if (!scene) return scene.error();
  const double parse_seconds = timer.seconds();
  const auto settings = settings_of(o, scene->film);
  if (!settings) return settings.error();
  const RenderOptions first = of_frame(o, frames->front());
  const std::vector<std::string> outputs{first.output, first.preview, first.heatmap, first.stats};
  if (auto usable = check_outputs(outputs, inputs_of(first, *scene)); !usable) return usable;
  if (!first.reference.empty() && !std::filesystem::is_regular_file(first.reference)) {
    return Error{ErrorClass::missing, first.reference, "there is no such picture to compare with"};
  }
  catch_interrupts();
  const bool text = !o.quiet && o.stats != "-";
  if (o.check) {
    const double first_frame = frames->front();
    auto loaded = render::load_scene(*scene, *settings, {&first_frame, 1}, render::Extent::all);
    if (!loaded) return loaded.error();
    for (int frame : *frames) {
      if (const auto moved = render::move_to(*loaded, *scene, frame); !moved) return moved.error();
    }
    if (text) print_contents(o.scene, *loaded);
    return {};
  }
  const auto devices = render::choose_devices(o.device);
  if (!devices) return devices.error();
  const auto hash = scene_hash(o);
  if (!hash) return hash.error();
  if (text) {
    const std::string& reason = devices->front().reason;
    fmt::print("{}: on {}{}\n", o.scene, described(*devices), reason.empty() ? "" : fmt::format(" ({})", reason));
  }
  FrameLoop loop(o, *scene, *settings, *hash, parse_seconds);
  return loop.render(*frames, *devices);
}

}  // namespace kd::tools
