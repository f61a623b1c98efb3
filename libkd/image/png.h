// Previews as PNG.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "sys/result.h"

namespace kd::image {

/// 8-bit RGB, interleaved, row 0 at the top, already in display space; 1 to 2^28 pixels. Atomic. ErrorClass::output if
/// the file cannot be written or `rgb` is not 3 x width x height bytes, ErrorClass::resource if memory runs out.
Result<void> write_png(const std::string& path, uint32_t width, uint32_t height, std::span<const uint8_t> rgb);

}  // namespace kd::image
