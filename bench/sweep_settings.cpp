#include "sweep_settings.h"

#include <charconv>
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

Result<double> parse_price(const std::string& text) {
  const auto price = parse<double>(text);
  if (price && *price >= 0 && *price <= 1e6) return *price;
  return Error{ErrorClass::usage, "--price " + text, "not a cost of a byte a triangle, 0 or more"};
}

Result<int> parse_depth(const std::string& text) {
  const auto depth = parse<int>(text);
  if (depth && *depth >= 1 && *depth <= kMaxDepth) return *depth;
  return Error{ErrorClass::usage, "--depth " + text, fmt::format("not a number of inner nodes, 1 to {}", kMaxDepth)};
}

}  // namespace

Result<std::vector<SweepPoint>> sweep_points(const SweepLists& lists) {
  std::vector<SweepPoint> points;
  for (const std::string& costs_text : lists.costs) {
    auto costs = parse_costs(costs_text);
    if (!costs) return costs.error();
    for (const std::string& bonus_text : lists.bonuses) {
      auto bonus = parse_bonus(bonus_text);
      if (!bonus) return bonus.error();
      costs->empty_bonus = *bonus;
      for (const std::string& price_text : lists.prices) {
        auto price = parse_price(price_text);
        if (!price) return price.error();
        costs->byte_price = *price;
        for (const std::string& depth_text : lists.depths) {
          auto depth = parse_depth(depth_text);
          if (!depth) return depth.error();
          points.push_back({costs_text, bonus_text, price_text, depth_text, {*costs, *depth}});
        }
      }
    }
  }
  return points;
}

}  // namespace kd::bench
