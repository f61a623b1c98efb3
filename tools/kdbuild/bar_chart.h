// Bar charts as SVG text: panels with axes, a light grid, ticks and a legend. Lengths in pixels, y downwards.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kd::tools {

struct BarSeries {
  std::string name;  // for the legend, if there are two
  std::string colour;
  std::vector<double> values;  // one a label, >= 0
};

/// One chart. Texts are plain: they are escaped where they are drawn.
struct BarPanel {
  std::string title;
  std::string note;  // below the title
  std::string x_axis;
  std::string y_axis;
  std::vector<std::string> labels;  // of the bars; those that fit are shown
  std::vector<BarSeries> series;    // one or two
  bool stacked = false;             // on each other, or else side by side
};

constexpr int kPanelWidth = 480;
constexpr int kPanelHeight = 320;

/// The panel with its upper left corner at (x, y), as SVG elements.
std::string bar_panel_svg(const BarPanel& panel, int x, int y);

/// Text for XML: markup escaped, and bytes that are no UTF-8 or no character of XML 1.0 replaced by U+FFFD.
std::string xml_text(std::string_view text);

}  // namespace kd::tools
