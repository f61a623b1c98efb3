// Films as OpenEXR: scanlines, ZIP, 32-bit channels as they lie in the film.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "image/film.h"
#include "sys/result.h"

namespace kd::image {

/// Row by row, for points as row vectors: p' = p M.
using Matrix4 = std::array<float, 16>;

struct ExrHeader {
  std::optional<double> gamma;  // attribute "gamma", a float; only if the colour is no longer scene-linear
  std::string software;         // attribute "software"; left out if empty
  std::vector<std::pair<std::string, std::string>> text;     // further attributes: name (1 to 255 bytes), value
  std::vector<std::pair<std::string, double>> numbers = {};  // the same, as doubles
  // "worldToCamera": right-handed, looking along -z, y up; "worldToNDC": (0, 0) is the picture's upper left corner, (1,
  // 1) its lower right.
  std::optional<Matrix4> world_to_camera = {};
  std::optional<Matrix4> world_to_ndc = {};
};

/// The text attribute of that name of an EXR that is whole; nothing if there is no such file, or it is cut short.
std::optional<std::string> read_exr_text(const std::string& path, const std::string& name);

/// The film is the data window, its picture the display window. Primaries are Rec. 709's. Writes channels R, G, B, A
/// and those of the film's AOVs, each AOV once, atomically. ErrorClass::output if the file cannot be written, a text's
/// name is one of OpenEXR's own, or a buffer of the film does not have the film's size.
Result<void> write_exr(const std::string& path, const Film& film, const ExrHeader& header);

}  // namespace kd::image
