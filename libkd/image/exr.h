// Films as OpenEXR: scanlines, ZIP, 32-bit channels as they lie in the film.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "image/film.h"
#include "sys/result.h"

namespace kd::image {

struct ExrHeader {
  std::optional<double> gamma;  // attribute "gamma", a float; only if the colour is no longer scene-linear
  std::string software;         // attribute "software"; left out if empty
  std::vector<std::pair<std::string, std::string>> text;  // further attributes: name (1 to 255 bytes), value
};

/// The film is the data window, its picture the display window. Writes channels R, G, B, A and those of the film's
/// AOVs, each AOV once, atomically. ErrorClass::output if the file cannot be written, a text's name is one of OpenEXR's
/// own, or a buffer of the film does not have the film's size.
Result<void> write_exr(const std::string& path, const Film& film, const ExrHeader& header);

}  // namespace kd::image
