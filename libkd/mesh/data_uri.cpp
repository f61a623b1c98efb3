#include "mesh/data_uri.h"

#include <array>
#include <cstdint>

namespace kd::mesh {
namespace {

constexpr uint8_t kNone = 64;

/// What each character stands for, or kNone.
constexpr std::array<uint8_t, 256> digit_values() {
  std::array<uint8_t, 256> values{};
  values.fill(kNone);
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t i = 0; i < digits.size(); ++i) values[static_cast<unsigned char>(digits[i])] = static_cast<uint8_t>(i);
  return values;
}
constexpr std::array<uint8_t, 256> kValues = digit_values();

}  // namespace

std::optional<std::vector<std::byte>> decode_data_uri(std::string_view uri, Watch& watch) {
  const size_t comma = uri.find(',');
  if (comma == std::string_view::npos || !uri.starts_with("data:")) return std::nullopt;
  if (!uri.substr(0, comma).ends_with(";base64")) return std::nullopt;
  std::string_view text = uri.substr(comma + 1);
  for (int i = 0; i < 2 && text.ends_with('='); ++i) text.remove_suffix(1);

  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  uint32_t group = 0;  // the last digits, six bits each
  for (size_t i = 0; i < text.size(); ++i) {
    watch.step();
    const uint8_t value = kValues[static_cast<unsigned char>(text[i])];
    if (value == kNone) return std::nullopt;
    group = group << 6 | value;
    if (i % 4 != 0) bytes.push_back(static_cast<std::byte>(group >> (6 - 2 * (i % 4)) & 0xff));
  }
  if (bytes.empty() || text.size() % 4 == 1) return std::nullopt;
  return bytes;
}

}  // namespace kd::mesh
