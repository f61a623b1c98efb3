#include "image/channels.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

namespace kd::image {

namespace {

Error unknown_aov(std::string_view name) {
  std::string known;
  for (const AovRow& row : kAovRows) known += fmt::format("{}{}", known.empty() ? "" : ", ", row.name);
  return {ErrorClass::usage, {}, fmt::format("there is no AOV '{}': choose from {}", name, known)};
}

}  // namespace

Result<std::vector<Aov>> parse_aovs(std::string_view names) {
  std::vector<Aov> aovs;
  if (names.empty()) return aovs;
  for (size_t begin = 0; begin <= names.size();) {
    const size_t end = std::min(names.find(',', begin), names.size());
    const std::string_view name = names.substr(begin, end - begin);
    const auto row = std::find_if(kAovRows.begin(), kAovRows.end(), [&](const AovRow& r) { return r.name == name; });
    if (row == kAovRows.end()) return unknown_aov(name);
    if (std::find(aovs.begin(), aovs.end(), row->aov) == aovs.end()) aovs.push_back(row->aov);
    begin = end + 1;
  }
  return aovs;
}

}  // namespace kd::image
