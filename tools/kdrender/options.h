// What kdrender's command line can say.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "image/film.h"
#include "scene/scene.h"
#include "sys/result.h"

namespace kd::tools {

struct RenderOptions {
  std::string scene, output, preview, heatmap, stats, aovs, reference, size, crop, frames;
  std::vector<std::string> overrides;  // "path=value"
  std::string device = "auto", layout = "auto";
  uint32_t samples = 1;
  double gamma = 2.2;
  double threshold = 0;
  bool gamma_on_exr = false;
  bool check = false;
  bool resume = false;
  unsigned threads = 0;
  bool quiet = false;
};

void add_options(CLI::App& app, RenderOptions& o);

/// "1920x1080", within what a film may have. ErrorClass::usage.
Result<scene::FilmSize> parse_size(const std::string& text);

/// "COLUMN,ROW,WIDTH,HEIGHT", not empty and within the film. ErrorClass::usage.
Result<image::Window> parse_crop(const std::string& text, const scene::FilmSize& film);

}  // namespace kd::tools
