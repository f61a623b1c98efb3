#include "kdrender/options.h"

#include <fmt/format.h>

#include "common/console.h"
#include "common/numbers.h"
#include "image/channels.h"
#include "render/load.h"

namespace kd::tools {

void add_options(CLI::App& app, RenderOptions& o) {
  std::string aov_help = "AOVs to write as further channels, separated by commas:";
  for (const image::AovRow& row : image::kAovRows) aov_help += fmt::format(" {}", row.name);
  app.add_option("scene", o.scene, "Scene file (JSON, see schema/scene.fbs)")->required();
  app.add_option("-o,--output", o.output, "The EXR to write: R, G, B, A and AOVs, scene-linear")->check(file_name());
  app.add_option("--preview", o.preview, "Write an 8-bit PNG too, through the gamma stage")->check(file_name());
  app.add_option("--device", o.device, "auto, cpu, cuda, cuda:N, cuda:all, or a list of these")->capture_default_str();
  app.add_option(
         "--layout", o.layout,
         "How triangles lie in memory: expanded; compact, about half the bytes and slower; or auto, compact where "
         "a GPU has too little memory for expanded")
      ->check(CLI::IsMember({"auto", "expanded", "compact"}))
      ->capture_default_str();
  app.add_option("--frames", o.frames,
                 "Frames of a film: 12, 1-240 or 1-240x2; a # in an output's name is a digit of them");
  app.add_flag("--resume", o.resume,
               "Leave out frames whose EXR is there, whole, and of this scene and these settings");
  app.add_option("--set", o.overrides, "Change a value of the scene first: PATH=JSON, such as camera.vertical_fov=35")
      ->take_all()
      ->allow_extra_args(false);
  app.add_option("--size", o.size, "Size of the film instead of the scene's, such as 1920x1080");
  app.add_option("--crop", o.crop, "Render only this part of the film: COLUMN,ROW,WIDTH,HEIGHT in pixels");
  app.add_option("--spp", o.samples, "Samples a pixel, under a tent filter; 1: its centre")
      ->check(whole_number(1, render::kMaxSamples))
      ->capture_default_str();
  app.add_option("--aov", o.aovs, aov_help);
  app.add_option("--heatmap", o.heatmap, "Write a PNG of what each pixel's ray costs: nodes and triangles visited")
      ->check(file_name());
  app.add_option("--gamma", o.gamma, "Gamma of the preview")->check(number(0.1, 10))->capture_default_str();
  app.add_flag("--gamma-exr", o.gamma_on_exr, "Apply the gamma to the EXR as well; its header then says so");
  app.add_option("--compare", o.reference, "Compare with this EXR's R, G, B and A; exit status 11 if it differs")
      ->check(file_name());
  app.add_option("--threshold", o.threshold, "The largest difference of a channel that --compare lets pass")
      ->check(number(0, 1e30))
      ->capture_default_str();
  app.add_flag("--check", o.check, "Read the scene and its objects and say what is in it; render nothing");
  app.add_option("--stats", o.stats, "Write a JSON report to this file, or to stdout (-)");
  app.add_option("--threads", o.threads, "CPU threads to use; 0: all cores")
      ->check(whole_number(0, 4096))
      ->capture_default_str();
  app.add_flag("--quiet", o.quiet, "Print nothing but errors");
}

Result<scene::FilmSize> parse_size(const std::string& text) {
  const auto sides = parse_numbers(text, 'x');
  const auto fits = [](uint32_t side) { return side >= 1 && side <= scene::kMaxFilmSide; };
  if (!sides || sides->size() != 2 || !fits(sides->front()) || !fits(sides->back()) ||
      uint64_t{sides->front()} * sides->back() > scene::kMaxFilmPixels) {
    return Error{
        ErrorClass::usage, fmt::format("--size {}", text),
        fmt::format("not a size such as 1920x1080, of at most {} a side and 2^28 pixels", scene::kMaxFilmSide)};
  }
  return scene::FilmSize{sides->front(), sides->back()};
}

Result<image::Window> parse_crop(const std::string& text, const scene::FilmSize& film) {
  const auto n = parse_numbers(text, ',');
  const std::string where = fmt::format("--crop {}", text);
  if (!n || n->size() != 4 || (*n)[2] == 0 || (*n)[3] == 0) {
    return Error{ErrorClass::usage, where, "not a part of a film such as 0,0,640,360: COLUMN,ROW,WIDTH,HEIGHT"};
  }
  const image::Window window{(*n)[0], (*n)[1], (*n)[2], (*n)[3]};
  if (uint64_t{window.column} + window.width > film.width || uint64_t{window.row} + window.height > film.height) {
    return Error{ErrorClass::usage, where, fmt::format("beyond the film of {} x {} pixels", film.width, film.height)};
  }
  return window;
}

}  // namespace kd::tools
