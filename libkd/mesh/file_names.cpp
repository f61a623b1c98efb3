#include "mesh/file_names.h"

#include <fmt/format.h>

#include "mesh/text.h"

namespace kd::mesh {
namespace {

constexpr size_t kMostBytes = 80;

std::string fit(std::string_view wish) {
  std::string name;
  for (const char c : wish) {
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    const bool is_plain = is_letter || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
    const bool goes_on = (static_cast<unsigned char>(c) & 0xc0) == 0x80;  // of a character in UTF-8
    if (name.size() == kMostBytes) break;
    if (is_plain) name += c;
    if (!is_plain && !goes_on) name += '_';
  }
  if (name.empty()) name = "mesh";
  if (name[0] == '.' || name[0] == '-') name[0] = '_';
  return name;
}

}  // namespace

std::string FileNames::give(std::string_view wish) {
  std::string name = fit(wish);
  const auto [entry, fresh] = taken_.try_emplace(lower_case(name), 1);
  if (fresh) return name;
  uint64_t& clashes = entry->second;
  for (;;) {
    std::string numbered = fmt::format("{}_{}", name, ++clashes);
    if (taken_.try_emplace(lower_case(numbered), 1).second) return numbered;
  }
}

}  // namespace kd::mesh
