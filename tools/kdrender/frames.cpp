#include "kdrender/frames.h"

#include <charconv>
#include <cstdint>

#include <fmt/format.h>

namespace kd::tools {

namespace {

constexpr int64_t kMostFrames = 1'000'000;

/// Reads a number of at most nine digits, with its sign, off the front of `text`.
bool take_number(std::string_view& text, int& number) {
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), number);
  if (parsed.ec != std::errc{} || number > 999'999'999 || number < -999'999'999) return false;
  text.remove_prefix(static_cast<size_t>(parsed.ptr - text.data()));
  return true;
}

bool take(std::string_view& text, char c) {
  if (!text.starts_with(c)) return false;
  text.remove_prefix(1);
  return true;
}

}  // namespace

Result<std::vector<int>> parse_frames(const std::string& text) {
  std::string_view rest = text;
  int first = 0, last = 0, step = 1;
  bool good = take_number(rest, first);
  last = first;
  if (good && take(rest, '-')) good = take_number(rest, last);
  if (good && take(rest, 'x')) good = take_number(rest, step);
  good = good && rest.empty() && last >= first && step >= 1 && (int64_t{last} - first) / step < kMostFrames;
  if (!good) {
    return Error{ErrorClass::usage, fmt::format("--frames {}", text),
                 "not frames such as 12, 1-240 or 1-240x2, ascending, a million at most"};
  }
  std::vector<int> frames;
  for (int64_t frame = first; frame <= last; frame += step) frames.push_back(static_cast<int>(frame));
  return frames;
}

bool is_numbered(const std::string& pattern) {
  const size_t folder = pattern.rfind('/');
  return pattern.find('#', folder == std::string::npos ? 0 : folder) != std::string::npos;
}

std::string numbered(const std::string& pattern, int frame) {
  const size_t last = pattern.rfind('#');
  if (!is_numbered(pattern)) return pattern;
  const size_t before = pattern.find_last_not_of('#', last);
  const size_t first = before == std::string::npos ? 0 : before + 1;
  return fmt::format("{}{:0{}}{}", pattern.substr(0, first), frame, last - first + 1, pattern.substr(last + 1));
}

}  // namespace kd::tools
