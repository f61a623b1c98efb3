#include "kdrender/outputs.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "common/console.h"
#include "common/layout.h"
#include "image/compare.h"
#include "image/heatmap.h"
#include "image/png.h"
#include "kdrender/exr_header.h"
#include "sys/hash.h"

namespace kd::tools {

namespace {

constexpr const char* kFingerprint = "fingerprint";

bool asks_for_visits(const RenderOptions& o) {
  const auto asked = image::parse_aovs(o.aovs);
  return asked && std::find(asked->begin(), asked->end(), image::Aov::visits) != asked->end();
}

image::ExrHeader header_of(const RenderOptions& o, const FrameNotes& notes) {
  image::ExrHeader header;
  header.software = version_text();
  if (o.gamma_on_exr) header.gamma = o.gamma;
  header.world_to_camera = world_to_camera(notes.camera);
  header.world_to_ndc = world_to_ndc(notes.camera, notes.film);
  header.text = {{"device", notes.device},
                 {"sceneHash", notes.scene_hash},
                 {"objectsHash", notes.objects_hash},
                 {kFingerprint, notes.fingerprint}};
  header.numbers = {{"frame", notes.frame}, {"samples", o.samples}, {"renderSeconds", notes.render_seconds}};
  return header;
}

Result<uint32_t> write_heatmap(const RenderOptions& o, image::Film& film) {
  const auto visits = std::find_if(film.aovs.begin(), film.aovs.end(),
                                   [](const image::AovBuffer& buffer) { return buffer.aov == image::Aov::visits; });
  const uint32_t most = image::most_visits(*visits);
  auto written = image::write_png(o.heatmap, film.width, film.height, image::heatmap(*visits, most));
  if (!written) return written.error();
  if (!asks_for_visits(o)) film.aovs.erase(visits);
  return most;
}

}  // namespace

Result<render::RenderSettings> settings_of(const RenderOptions& o, const scene::FilmSize& film) {
  render::RenderSettings settings;
  auto aovs = image::parse_aovs(o.aovs);
  if (!aovs) return aovs.error();
  settings.aovs = std::move(*aovs);
  if (!o.heatmap.empty() && !asks_for_visits(o)) settings.aovs.push_back(image::Aov::visits);
  settings.samples = o.samples;
  settings.preview = !o.preview.empty();
  settings.gamma = o.gamma;
  settings.gamma_on_film = o.gamma_on_exr;
  settings.layout = layout_named(o.layout);  // auto: none
  if (!o.crop.empty()) {
    auto crop = parse_crop(o.crop, film);
    if (!crop) return crop.error();
    settings.crop = *crop;
  }
  return settings;
}

std::string fingerprint(const RenderOptions& o, const std::string& scene_hash, const std::string& objects_hash,
                        int frame) {
  const std::string text =
      fmt::format("{} {} {} frame {} size {} crop {} samples {} aovs {} gamma {}", version_text(), scene_hash,
                  objects_hash, frame, o.size, o.crop, o.samples, o.aovs, o.gamma_on_exr ? o.gamma : 1.0);
  return hash_text(hash_bytes(text.data(), text.size()));
}

bool is_done(const RenderOptions& o, const std::string& fingerprint) {
  for (const std::string* name : {&o.preview, &o.heatmap, &o.stats}) {
    if (!name->empty() && !std::filesystem::exists(*name)) return false;
  }
  const auto found = image::read_exr_text(o.output, kFingerprint);
  return found && *found == fingerprint;
}

Result<uint32_t> write_images(const RenderOptions& o, render::Frame& frame, const FrameNotes& notes) {
  uint32_t most = 0;
  if (!o.heatmap.empty()) {
    const auto written = write_heatmap(o, frame.film);
    if (!written) return written;
    most = *written;
  }
  if (!o.preview.empty()) {
    const auto written = image::write_png(o.preview, frame.film.width, frame.film.height, frame.preview);
    if (!written) return written.error();
  }
  if (o.output.empty()) return most;
  const auto written = image::write_exr(o.output, frame.film, header_of(o, notes));
  return written ? Result<uint32_t>(most) : written.error();
}

Result<std::string> compare(const RenderOptions& o, const image::Film& film) {
  const auto reference = image::read_exr_colour(o.reference);
  if (!reference) return reference.error();
  if (reference->width != film.width || reference->height != film.height) {
    return Error{ErrorClass::differs, o.reference,
                 fmt::format("it has {} x {} pixels, the film {} x {}", reference->width, reference->height, film.width,
                             film.height)};
  }
  if (reference->column != film.column || reference->row != film.row) {
    return Error{ErrorClass::differs, o.reference, "it is another part of its picture than the film"};
  }
  const image::Difference difference = image::compare_colour(film, *reference);
  const std::string text = fmt::format("{} pixels differ, by up to {:.6g}, RMSE {:.6g}", difference.pixels,
                                       difference.largest, difference.rmse);
  if (difference.largest > o.threshold) {
    return Error{ErrorClass::differs, o.reference, fmt::format("{}; {:.6g} may be", text, o.threshold)};
  }
  return text;
}

}  // namespace kd::tools
