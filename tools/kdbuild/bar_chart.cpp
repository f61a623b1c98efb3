#include "kdbuild/bar_chart.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

#include <fmt/format.h>

namespace kd::tools {

namespace {

constexpr double kLeft = 62, kTop = 62, kPlotWidth = 396, kPlotHeight = 196;  // of the plot, in its panel
constexpr double kGlyphWidth = 5.8;  // of a letter or digit of 11 pixels, on average and with some air

/// The character that starts a text and the bytes it takes; U+FFFD for what XML does not allow.
struct Character {
  uint32_t code = 0xfffd;
  size_t bytes = 1;
};

Character first_character(std::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<uint8_t>(text[i]); };
  const uint8_t lead = byte(0);
  const size_t length = lead < 0x80 ? 1 : lead >> 5 == 6 ? 2 : lead >> 4 == 14 ? 3 : lead >> 3 == 30 ? 4 : 0;
  if (length == 0 || length > text.size()) return {};
  uint32_t code = length == 1 ? lead : lead & (0x7fu >> length);
  for (size_t i = 1; i < length; ++i) {
    if (byte(i) >> 6 != 2) return {};
    code = code << 6 | (byte(i) & 0x3fu);
  }
  constexpr uint32_t kShortest[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xd800 && code <= 0xdfff;
  if (code < std::max(0x20u, kShortest[length]) || surrogate || code == 0xfffe || code == 0xffff || code > 0x10ffff) {
    return {};
  }
  return {code, length};
}

/// Of a text as drawn at 11 pixels, roughly.
double drawn_width(std::string_view text) {
  const auto starts = [](char c) { return (static_cast<uint8_t>(c) & 0xc0) != 0x80; };
  return kGlyphWidth * static_cast<double>(std::count_if(text.begin(), text.end(), starts));
}

/// 1500 -> "1.5k".
std::string short_number(double value) {
  if (value >= 1e9) return fmt::format("{:g}G", value * 1e-9);
  if (value >= 1e6) return fmt::format("{:g}M", value * 1e-6);
  if (value >= 1e3) return fmt::format("{:g}k", value * 1e-3);
  return fmt::format("{:g}", value);
}

/// A step of 1, 2 or 5 times a power of ten that takes at most five of them to the top.
double tick_step(double top) {
  if (!(top > 0)) return 1;
  const double power = std::pow(10, std::floor(std::log10(top / 5)));
  for (double factor : {1.0, 2.0, 5.0}) {
    if (factor * power * 5 >= top) return factor * power;
  }
  return 10 * power;
}

class Panel {
 public:
  Panel(const BarPanel& panel, int x, int y) : panel_(panel), x_(x + kLeft), y_(y + kTop) {
    double highest = 0;
    for (size_t i = 0; i < panel.labels.size(); ++i) {
      double sum = 0;
      for (const BarSeries& s : panel.series) sum = panel.stacked ? sum + s.values[i] : std::max(sum, s.values[i]);
      highest = std::max(highest, sum);
    }
    step_ = tick_step(highest);
    top_ = step_ * std::max(1.0, std::ceil(highest / step_ - 1e-9));
    slot_ = kPlotWidth / static_cast<double>(std::max<size_t>(1, panel.labels.size()));
  }

  std::string svg() {
    heading();
    grid();
    bars();
    labels();
    return std::move(out_);
  }

 private:
  template <class... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<Values>(values)...);
  }
  double height_of(double value) const { return kPlotHeight * value / top_; }

  void heading() {
    add("<text class=\"h\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x_, y_ - 34, xml_text(panel_.title));
    add("<text class=\"n\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x_, y_ - 15, xml_text(panel_.note));
    if (panel_.series.size() < 2) return;
    double right = x_ + kPlotWidth;
    for (auto s = panel_.series.rbegin(); s != panel_.series.rend(); ++s) {
      right -= drawn_width(s->name);
      add("<text class=\"t\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", right, y_ - 34, xml_text(s->name));
      add("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"10\" height=\"10\" fill=\"{}\"/>\n", right - 15, y_ - 43, s->colour);
      right -= 28;
    }
  }

  void grid() {
    for (int i = 0; i * step_ <= top_ * (1 + 1e-9); ++i) {
      const double y = y_ + kPlotHeight - height_of(i * step_);
      add("<path class=\"{}\" d=\"M{:.1f} {:.1f}h{:.1f}\"/>\n", i == 0 ? "a" : "g", x_, y, kPlotWidth);
      add("<text class=\"t e\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x_ - 8, y + 4, short_number(i * step_));
    }
    add("<text class=\"t m\" transform=\"translate({:.1f} {:.1f}) rotate(-90)\">{}</text>\n", x_ - 46,
        y_ + kPlotHeight / 2, xml_text(panel_.y_axis));
  }

  void bars() {
    const double width = 0.8 * slot_ / (panel_.stacked ? 1.0 : static_cast<double>(panel_.series.size()));
    for (size_t i = 0; i < panel_.labels.size(); ++i) {
      double x = x_ + (static_cast<double>(i) + 0.1) * slot_, base = y_ + kPlotHeight;
      for (const BarSeries& s : panel_.series) {
        const double height = height_of(s.values[i]);
        if (height > 0) {
          add("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\"/>\n", x, base - height,
              width, height, s.colour);
        }
        (panel_.stacked ? base : x) += panel_.stacked ? -height : width;
      }
    }
  }

  /// As many as have room, the first always.
  void labels() {
    double wanted = 0;
    for (const std::string& label : panel_.labels) wanted = std::max(wanted, drawn_width(label) + 8);
    size_t stride = 1;
    for (size_t nice : {2u, 5u, 10u, 20u, 50u}) {
      if (static_cast<double>(stride) * slot_ < wanted) stride = nice;
    }
    for (size_t i = 0; i < panel_.labels.size(); i += stride) {
      add("<text class=\"t m\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x_ + (static_cast<double>(i) + 0.5) * slot_,
          y_ + kPlotHeight + 17, xml_text(panel_.labels[i]));
    }
    add("<text class=\"t m\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x_ + kPlotWidth / 2, y_ + kPlotHeight + 38,
        xml_text(panel_.x_axis));
  }

  const BarPanel& panel_;
  double x_, y_;  // the plot's upper left corner
  double step_ = 1, top_ = 1;
  double slot_ = 1;  // width of a label's bars and the gap beside them
  std::string out_;
};

}  // namespace

std::string bar_panel_svg(const BarPanel& panel, int x, int y) { return Panel(panel, x, y).svg(); }

std::string xml_text(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const Character c = first_character(text);
    switch (c.code) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      case 0xfffd:
        out += "\xef\xbf\xbd";
        break;
      default:
        out += text.substr(0, c.bytes);
    }
    text.remove_prefix(c.bytes);
  }
  return out;
}

}  // namespace kd::tools
