// Numbers in an option's value.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace kd::tools {

/// The whole numbers of `text`, with `separator` between them, such as "1920x1080"; nothing if it is anything else.
inline std::optional<std::vector<uint32_t>> parse_numbers(std::string_view text, char separator) {
  std::vector<uint32_t> numbers;
  const char *at = text.data(), *end = at + text.size();
  while (true) {
    uint32_t number = 0;
    const auto parsed = std::from_chars(at, end, number);
    if (parsed.ec != std::errc{}) return std::nullopt;
    numbers.push_back(number);
    if (parsed.ptr == end) return numbers;
    if (*parsed.ptr != separator) return std::nullopt;
    at = parsed.ptr + 1;
  }
}

}  // namespace kd::tools
