// A frame's pixels in the order in which packets take them: 4 x 2 pixels a packet, so that its rays are near one
// another, and packets tile by tile, so that what one reads of a scene the next finds in the caches.
#pragma once

#include <algorithm>

#include "core/packet.h"

namespace kd::render {

class Tiles {
 public:
  Tiles(uint32_t width, uint32_t height) : width_(width), height_(height), a_row_((width + kSide - 1) / kSide) {}

  size_t count() const { return a_row_ * ((height_ + kSide - 1) / kSide); }

  /// Calls visit(pixels, set) for each packet of a tile: pixels by number, in row order, those of `set` within the
  /// frame.
  template <class Visit>
  void for_each_packet(size_t tile, const Visit& visit) const {
    const auto left = static_cast<uint32_t>(tile % a_row_) * kSide, top = static_cast<uint32_t>(tile / a_row_) * kSide;
    const uint32_t right = std::min(left + kSide, width_), bottom = std::min(top + kSide, height_);
    for (uint32_t y = top; y < bottom; y += kPacketRows) {
      for (uint32_t x = left; x < right; x += kPacketColumns) {
        PerRay<uint32_t> pixels{};
        RaySet set = kNoRays;
        for (uint32_t i = 0; i < kPacketRays; ++i) {
          const uint32_t column = x + i % kPacketColumns, row = y + i / kPacketColumns;
          if (column >= right || row >= bottom) continue;
          pixels[i] = row * width_ + column;
          set |= set_of(i);
        }
        visit(pixels, set);
      }
    }
  }

 private:
  static constexpr uint32_t kPacketColumns = 4, kPacketRows = 2, kSide = 32;
  static_assert(kPacketColumns * kPacketRows == kPacketRays);

  uint32_t width_, height_;
  size_t a_row_;
};

}  // namespace kd::render
