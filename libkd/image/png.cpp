#include "image/png.h"

#include <cstddef>
#include <new>
#include <vector>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

#include "sys/atomic_file.h"

namespace kd::image {

namespace {

constexpr uint64_t kMaxPixels = 1ull << 28;  // stb counts bytes in an int

/// stb's callback: keeps the file, which comes in one piece. stb is C: nothing may be thrown through it.
void keep(void* context, void* data, int size) {
  const auto* first = static_cast<const std::byte*>(data);
  try {
    static_cast<std::vector<std::byte>*>(context)->assign(first, first + size);
  } catch (const std::bad_alloc&) {
    // An empty file is what write_png takes for the lack of memory.
  }
}

}  // namespace

Result<void> write_png(const std::string& path, uint32_t width, uint32_t height, std::span<const uint8_t> rgb) {
  const uint64_t pixels = uint64_t{width} * height;
  if (pixels == 0 || pixels > kMaxPixels || rgb.size() != 3 * pixels) {
    return Error{ErrorClass::output, path, "cannot write: the image is empty, too large or not of its size"};
  }
  std::vector<std::byte> file;
  const int stride = static_cast<int>(3 * width);
  const int written =
      stbi_write_png_to_func(keep, &file, static_cast<int>(width), static_cast<int>(height), 3, rgb.data(), stride);
  if (!written || file.empty()) return Error{ErrorClass::resource, path, "not enough memory to compress the image"};
  return write_file(path, file);
}

}  // namespace kd::image
