// Range checks of whole sections. Every open runs them, so they take blocks without a branch inside, which the compiler
// vectorises, and go through a block's values one by one only where one of them is out of range.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
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

namespace detail {

/// As first_triple_beyond, of triples that fill one Word each; limit < 2^bits.
template <class Word>
size_t first_packed_beyond(std::span<const uint32_t> packed, int bits, uint64_t limit) {
  const Word mask = (Word{1} << bits) - 1;
  const Word last = static_cast<Word>(limit) - 1;
  const size_t count = packed.size() * sizeof(uint32_t) / sizeof(Word);
  for (size_t begin = 0; begin < count; begin += kCheckBlock) {
    const size_t end = std::min(begin + kCheckBlock, count);
    const auto beyond = [&](size_t i) {
      Word word;
      std::memcpy(&word, packed.data() + i * (sizeof(Word) / sizeof(uint32_t)), sizeof word);
      const Word x = word & mask, y = word >> bits & mask, z = word >> (2 * bits) & mask;
      // last - value wraps to a number of high bits where a value is beyond: nothing here comes near the top bit.
      return ((last - x) | (last - y) | (last - z)) >> (8 * sizeof(Word) - 1);
    };
    Word some = 0;
    for (size_t i = begin; i < end; ++i) some |= beyond(i);
    if (some == 0) continue;
    size_t i = begin;
    while (beyond(i) == 0) ++i;
    return i;
  }
  return count;
}

}  // namespace detail

/// The index of the first of these packed triples (`core/triple.h`) that has a number >= limit, or their count.
/// `packed` is a whole number of triples, limit >= 1.
inline size_t first_triple_beyond(std::span<const uint32_t> packed, int bits, uint64_t limit) {
  const auto words = static_cast<size_t>(triple_words(bits));
  if (words == 3) return first_beyond(packed, limit) / words;
  if (limit >> bits != 0) return packed.size() / words;  // no number of so many bits is
  return words == 1 ? detail::first_packed_beyond<uint32_t>(packed, bits, limit)
                    : detail::first_packed_beyond<uint64_t>(packed, bits, limit);
}

}  // namespace kd::nkd
