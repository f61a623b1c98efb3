// How far apart two pictures are.
#pragma once

#include <cstdint>
#include <string>

#include "image/film.h"
#include "sys/result.h"

namespace kd::image {

/// The colour of an EXR file, of any tool: R, G, B, and A, which is 1 where the file has none. ErrorClass::missing if
/// it cannot be opened, ErrorClass::usage if it is no picture with these channels or is cut short.
Result<Film> read_exr_colour(const std::string& path);

struct Difference {
  double largest = 0;   // of any channel of any pixel, absolute; infinite where one value alone is no number
  double rmse = 0;      // over all channels and pixels
  uint64_t pixels = 0;  // that differ in some bit
};

/// Over R, G, B and A of two films of the same size.
Difference compare_colour(const Film& a, const Film& b);

}  // namespace kd::image
