// PNG previews, decoded again by stb_image.
#include "image/png.h"

#include <cstring>
#include <fstream>
#include <iterator>
#include <vector>

#include <doctest/doctest.h>

#include "support/temp_folder.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb/stb_image.h>

using namespace kd;
using namespace kd::image;

TEST_CASE("png: the pixels come back, rows from the top") {
  const kd::test::TempFolder folder;
  const std::string path = folder.file("preview.png");
  constexpr uint32_t kWidth = 31, kHeight = 17;
  std::vector<uint8_t> rgb;
  for (size_t i = 0; i < size_t{3} * kWidth * kHeight; ++i) rgb.push_back(static_cast<uint8_t>(i * i % 251));
  const auto written = write_png(path, kWidth, kHeight, rgb);
  REQUIRE_MESSAGE(written, written.error().line());

  std::ifstream stream(path, std::ios::binary);
  const std::vector<char> file((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  REQUIRE(file.size() > 8);
  CHECK(std::memcmp(file.data(), "\x89PNG\r\n\x1a\n", 8) == 0);

  int width = 0, height = 0, channels = 0;
  uint8_t* decoded = stbi_load_from_memory(reinterpret_cast<const uint8_t*>(file.data()), static_cast<int>(file.size()),
                                           &width, &height, &channels, 0);
  REQUIRE(decoded);
  CHECK(width == kWidth);
  CHECK(height == kHeight);
  CHECK(channels == 3);
  CHECK(std::memcmp(decoded, rgb.data(), rgb.size()) == 0);
  stbi_image_free(decoded);
}

TEST_CASE("png: what cannot be written is an output error and leaves nothing behind") {
  const kd::test::TempFolder folder;
  const std::vector<uint8_t> rgb(12);
  const auto fails = [&](const std::string& path, uint32_t width, uint32_t height) {
    const auto written = write_png(path, width, height, rgb);
    REQUIRE(!written);
    CHECK(written.error().error_class == ErrorClass::output);
    CHECK(written.error().where == path);
    CHECK(folder.is_empty());
  };
  fails(folder.file("no/such/folder.png"), 2, 2);
  fails(folder.file("out.png"), 2, 3);
  fails(folder.file("out.png"), 0, 0);
  fails(folder.file("out.png"), 0xffffffffu, 0xffffffffu);
}
