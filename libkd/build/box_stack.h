// The triangles of a cell and of the cells still open above it, one stack: each with the box of its part in its cell.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/box.h"

namespace kd::build {

struct BoxStack {
  struct Interval {
    std::vector<int32_t> lo, hi;
  };
  std::array<Interval, 3> axes;
  std::vector<uint32_t> triangles;
  size_t size = 0;

  /// Makes room for `count` more.
  void reserve(size_t count);
  void push(uint32_t triangle, const Box3u& box);
  Box3u box(size_t i) const;
};

}  // namespace kd::build
