// Range checks of whole sections. Every open runs them, so they take blocks without a branch inside, which the compiler
// vectorises, and go through a block's values one by one only where one of them is out of range.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "core/triple.h"

namespace kd::nkd {

constexpr size_t kCheckBlock = 4096;

/// The index of the first value >= limit, or the size.
template <class T>
size_t first_beyond(std::span<const T> values, uint64_t limit) {
  if (limit > std::numeric_limits<T>::max()) return values.size();
  const T bound = static_cast<T>(limit);
  for (size_t begin = 0; begin < values.size(); begin += kCheckBlock) {
    const auto block = values.subspan(begin, std::min(kCheckBlock, values.size() - begin));
    bool beyond = false;
    for (T value : block) beyond |= value >= bound;
    if (!beyond) continue;
    const auto first = std::find_if(block.begin(), block.end(), [&](T value) { return value >= bound; });
    return begin + static_cast<size_t>(first - block.begin());
  }
  return values.size();
}

/// The index of the first of these triples that has a number >= limit, or their count.
inline size_t first_triple_beyond(PackedTriples triples, size_t count, uint64_t limit) {
  const uint64_t last = limit - 1;
  // last - value wraps to a number with the top bit where a value is beyond: nothing here comes near 2^63.
  const auto beyond = [&](Vec3u t) { return ((last - t.x) | (last - t.y) | (last - t.z)) >> 63; };
  for (size_t begin = 0; begin < count; begin += kCheckBlock) {
    const size_t end = std::min(begin + kCheckBlock, count);
    uint64_t some = 0;
    for (size_t i = begin; i < end; ++i) some |= beyond(triples[i]);
    if (some == 0) continue;
    size_t i = begin;
    while (beyond(triples[i]) == 0) ++i;
    return i;
  }
  return count;
}

}  // namespace kd::nkd
