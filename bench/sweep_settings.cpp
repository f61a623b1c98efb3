#include "sweep_settings.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace kd::bench {

namespace {

/// The whole text as a number.
template <class Number>
std::optional<Number> parse(std::string_view text) {
  Number value{};
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc{} || end != text.data() + text.size()) return {};
  return value;
}

Result<SahCosts> parse_costs(const std::string& text) {
  const size_t colon = text.find(':');
  if (colon != std::string::npos) {
    const auto traversal = parse<double>(std::string_view(text).substr(0, colon));
    const auto intersection = parse<double>(std::string_view(text).substr(colon + 1));
    const auto usable = [](std::optional<double> cost) { return cost && *cost > 0 && *cost <= 1e6; };
    if (usable(traversal) && usable(intersection)) return SahCosts{*traversal, *intersection};
  }
  return Error{ErrorClass::usage, "--costs " + text, "not two costs above 0, traversal:intersection, such as 1:1.5"};
}

Result<double> parse_bonus(const std::string& text) {
  const auto bonus = parse<double>(text);
  if (bonus && *bonus >= 0 && *bonus < 1) return *bonus;
  return Error{ErrorClass::usage, "--bonus " + text, "not a share of a split's cost, 0 or more and less than 1"};
}

/// What BuildSettings::max_depth says of 0; a test holds the two together.
int automatic_depth(size_t triangles) {
  return static_cast<int>(std::lround(8 + 1.3 * std::log2(static_cast<double>(triangles))));
}

/// "auto" is left to the builder.
Result<int> parse_depth(const std::string& text, size_t triangles) {
  const std::string_view given = text;
  if (given == "auto") return 0;
  if (given.starts_with("auto+") || given.starts_with("auto-")) {
    const auto more = parse<int>(given.substr(5));
    const int sign = given[4] == '+' ? 1 : -1;
    if (more && *more >= 0 && *more <= kMaxDepth) {
      return std::clamp(automatic_depth(triangles) + sign * *more, 1, kMaxDepth);
    }
  } else if (const auto depth = parse<int>(given); depth && *depth >= 1 && *depth <= kMaxDepth) {
    return *depth;
  }
  return Error{ErrorClass::usage, "--depth " + text,
               fmt::format("not auto, auto+N, auto-N or a number of inner nodes from 1 to {}", kMaxDepth)};
}

}  // namespace

Result<std::vector<SweepPoint>> sweep_points(const SweepLists& lists, size_t triangles) {
  std::vector<SweepPoint> points;
  for (const std::string& costs_text : lists.costs) {
    auto costs = parse_costs(costs_text);
    if (!costs) return costs.error();
    for (const std::string& bonus_text : lists.bonuses) {
      auto bonus = parse_bonus(bonus_text);
      if (!bonus) return bonus.error();
      costs->empty_bonus = *bonus;
      for (const std::string& depth_text : lists.depths) {
        auto depth = parse_depth(depth_text, triangles);
        if (!depth) return depth.error();
        points.push_back({costs_text, bonus_text, depth_text, {*costs, *depth}});
      }
    }
  }
  return points;
}

}  // namespace kd::bench
