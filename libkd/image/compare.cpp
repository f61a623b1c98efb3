#include "image/compare.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <limits>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

namespace kd::image {

namespace {

constexpr size_t kMostPixels = size_t{1} << 28;
constexpr const char* kChannels[] = {"R", "G", "B", "A"};

/// Throws what OpenEXR throws.
Result<Film> read_colour(const std::string& path) {
  Imf::InputFile file(path.c_str());
  const Imf::Header& header = file.header();
  for (const char* name : {"R", "G", "B"}) {
    if (!header.channels().findChannel(name)) {
      return Error{ErrorClass::usage, path, std::string("no picture to compare with: it has no channel ") + name};
    }
  }
  const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
  Film film;
  film.width = static_cast<uint32_t>(data.max.x - data.min.x + 1);
  film.height = static_cast<uint32_t>(data.max.y - data.min.y + 1);
  film.column = static_cast<uint32_t>(data.min.x - display.min.x);
  film.row = static_cast<uint32_t>(data.min.y - display.min.y);
  if (size_t{film.width} * film.height > kMostPixels) {
    return Error{ErrorClass::usage, path, "no picture to compare with: it has more than 2^28 pixels"};
  }
  film.picture_width = static_cast<uint32_t>(display.max.x - display.min.x + 1);
  film.picture_height = static_cast<uint32_t>(display.max.y - display.min.y + 1);
  film.colour.resize(4 * size_t{film.width} * film.height);
  Imf::FrameBuffer frame;
  const size_t pixel = 4 * sizeof(float);
  for (size_t c = 0; c < 4; ++c) {
    const double otherwise = c == 3 ? 1 : 0;
    frame.insert(kChannels[c], Imf::Slice::Make(Imf::FLOAT, film.colour.data() + c, data.min, film.width, 0, pixel,
                                                pixel * film.width, 1, 1, otherwise));
  }
  file.setFrameBuffer(frame);
  file.readPixels(data.min.y, data.max.y);
  return film;
}

}  // namespace

Result<Film> read_exr_colour(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    return Error{ErrorClass::missing, path, "there is no such file"};
  }
  try {
    return read_colour(path);
  } catch (const std::exception& e) {
    return Error{ErrorClass::usage, path, std::string("no picture to compare with: ") + e.what()};
  }
}

Difference compare_colour(const Film& a, const Film& b) {
  Difference difference;
  double squares = 0;
  for (size_t first = 0; first < a.colour.size(); first += 4) {
    bool differs = false;
    for (size_t i = first; i < first + 4; ++i) {
      if (std::bit_cast<uint32_t>(a.colour[i]) == std::bit_cast<uint32_t>(b.colour[i])) continue;
      differs = true;
      double off = std::fabs(static_cast<double>(a.colour[i]) - static_cast<double>(b.colour[i]));
      if (std::isnan(off)) off = std::numeric_limits<double>::infinity();
      difference.largest = std::max(difference.largest, off);
      squares += off * off;
    }
    difference.pixels += differs;
  }
  difference.rmse = std::sqrt(squares / static_cast<double>(std::max<size_t>(a.colour.size(), 1)));
  return difference;
}

}  // namespace kd::image
