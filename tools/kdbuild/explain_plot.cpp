#include <fmt/format.h>

#include "kdbuild/bar_chart.h"
#include "kdbuild/explain_report.h"
#include "sys/atomic_file.h"

namespace kd::tools {

namespace {

constexpr const char* kBlue = "#3f6fa8";
constexpr const char* kOrange = "#e39a3b";
constexpr size_t kLongestTitle = 60;  // bytes

constexpr const char* kHead = R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{1}" viewBox="0 0 {0} {1}">
<style>
text {{ font-family: "Helvetica Neue", Helvetica, Arial, "Liberation Sans", sans-serif; fill: #333; }}
.title {{ font-size: 20px; font-weight: 600; }}
.h {{ font-size: 14px; font-weight: 600; }}
.n {{ font-size: 12px; fill: #666; }}
.t {{ font-size: 11px; fill: #555; }}
.e {{ text-anchor: end; }}
.m {{ text-anchor: middle; }}
.g {{ stroke: #e4e4e4; }}
.a {{ stroke: #888; }}
</style>
<rect width="100%" height="100%" fill="#fff"/>
)";

/// A bin's name, short enough for an axis: "3", "≤16".
std::string axis_name(const Bin& bin) {
  return bin.lowest == bin.highest ? fmt::format("{}", bin.highest) : fmt::format("\u2264{}", bin.highest);
}

BarPanel cost_panel(const Explanation& t) {
  BarPanel panel{"SAH cost by depth", "", "depth", "SAH cost", {}, {}, true};
  panel.note = fmt::format("traversal {:.1f} + intersection {:.1f} = {:.1f}", t.traversal_cost, t.intersection_cost,
                           t.sah_cost());
  panel.series = {{"traversal", kBlue, {}}, {"intersection", kOrange, {}}};
  for (size_t depth = 0; depth < t.levels.size(); ++depth) {
    panel.labels.push_back(fmt::format("{}", depth));
    panel.series[0].values.push_back(t.levels[depth].traversal_cost);
    panel.series[1].values.push_back(t.levels[depth].intersection_cost);
  }
  return panel;
}

BarPanel depth_panel(const Explanation& t) {
  BarPanel panel{"Leaves by depth", "", "depth", "leaves", {}, {{"leaves", kBlue, {}}}};
  double sum = 0;
  for (size_t depth = 0; depth < t.levels.size(); ++depth) {
    const auto leaves = static_cast<double>(t.levels[depth].leaves);
    panel.labels.push_back(fmt::format("{}", depth));
    panel.series[0].values.push_back(leaves);
    sum += static_cast<double>(depth) * leaves;
  }
  panel.note = fmt::format("{} leaves, mean depth {:.1f}, deepest {}", t.leaves, sum / static_cast<double>(t.leaves),
                           t.levels.size() - 1);
  return panel;
}

BarPanel leaf_panel(const Explanation& t) {
  BarPanel panel{"Leaves by size", "", "triangles in a leaf", "share, %", {}, {}};
  panel.note = fmt::format("empty: {:.1f} % of the leaves, {:.1f} % of the volume, {:.1f} % of the visits",
                           100.0 * static_cast<double>(t.empty_leaves) / static_cast<double>(t.leaves),
                           100 * t.empty_volume, t.leaf_visits > 0 ? 100 * t.empty_visits / t.leaf_visits : 0);
  panel.series = {{"of leaves", kBlue, {}}, {"of visits (surface)", kOrange, {}}};
  for (const Bin& bin : t.leaf_sizes) {
    panel.labels.push_back(axis_name(bin));
    panel.series[0].values.push_back(100.0 * static_cast<double>(bin.count) / static_cast<double>(t.leaves));
    panel.series[1].values.push_back(t.leaf_visits > 0 ? 100 * bin.visits / t.leaf_visits : 0);
  }
  return panel;
}

BarPanel triangle_panel(const Explanation& t) {
  BarPanel panel{"Triangles by references", "", "leaves that hold a triangle", "share of triangles, %", {}, {}};
  panel.note = fmt::format("mean {:.2f}, median {}, 95 % at most {}, largest {}", t.mean_references(),
                           t.median_references, t.references_95, t.most_references);
  panel.series = {{"triangles", kBlue, {}}};
  for (const Bin& bin : t.triangle_references) {
    panel.labels.push_back(axis_name(bin));
    panel.series[0].values.push_back(100.0 * static_cast<double>(bin.count) / static_cast<double>(t.triangles));
  }
  return panel;
}

/// A long name loses its middle, but no part of a character.
std::string title(const std::string& name) {
  if (name.size() <= kLongestTitle) return name;
  const auto continues = [&](size_t i) { return (static_cast<unsigned char>(name[i]) & 0xc0) == 0x80; };
  size_t head = kLongestTitle / 2, tail = name.size() - kLongestTitle / 2;
  while (head > 0 && continues(head)) --head;
  while (tail < name.size() && continues(tail)) ++tail;
  return name.substr(0, head) + "\u2026" + name.substr(tail);
}

}  // namespace

Result<void> write_explanation_svg(const std::string& path, const ObjectExplanation& e) {
  constexpr int kMargin = 20, kHeading = 70;
  const Explanation& t = e.tree;
  std::string svg = fmt::format(kHead, 2 * kPanelWidth + 2 * kMargin, kHeading + 2 * kPanelHeight + kMargin);
  svg += fmt::format("<text class=\"title\" x=\"40\" y=\"36\">{}</text>\n", xml_text(title(e.name)));
  svg += fmt::format(
      "<text class=\"n\" x=\"40\" y=\"58\">{} triangles; SAH cost {:.2f} at 1 : 1.5; {:.2f} references, {:.2f} nodes "
      "and "
      "{:.1f} bytes a triangle</text>\n",
      t.triangles, t.sah_cost(), t.mean_references(), t.nodes_per_triangle(), e.bytes_per_triangle());
  const int right = kMargin + kPanelWidth, below = kHeading + kPanelHeight;
  svg += bar_panel_svg(cost_panel(t), kMargin, kHeading);
  svg += bar_panel_svg(depth_panel(t), right, kHeading);
  svg += bar_panel_svg(leaf_panel(t), kMargin, below);
  svg += bar_panel_svg(triangle_panel(t), right, below);
  svg += "</svg>\n";
  return write_file(path, svg);
}

}  // namespace kd::tools
