// A table whose rows are known one after the other: Markdown with aligned columns, and CSV.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace kd::bench {

class Table {
 public:
  /// Columns are at least `narrowest` wide, so that rows may be printed before all are known.
  explicit Table(std::vector<std::string> heads, size_t narrowest = 0) : narrowest_(narrowest) {
    rows_.push_back(std::move(heads));
  }

  /// As many cells as there are columns.
  void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

  /// The heads and the rule below them.
  std::string head() const {
    std::string rule = "|";
    for (size_t column = 0; column < rows_[0].size(); ++column)
      rule += fmt::format(" {:->{}}: |", "", width(column) - 1);
    return markdown_row(rows_[0]) + rule + "\n";
  }
  std::string last_row() const { return markdown_row(rows_.back()); }
  std::string markdown() const {
    std::string text = head();
    for (size_t row = 1; row < rows_.size(); ++row) text += markdown_row(rows_[row]);
    return text;
  }

  /// Cells hold neither commas nor quotation marks.
  std::string csv() const {
    std::string text;
    for (const auto& row : rows_) text += fmt::format("{}\n", fmt::join(row, ","));
    return text;
  }

 private:
  size_t width(size_t column) const {
    size_t widest = std::max<size_t>(narrowest_, 3);
    for (const auto& row : rows_) widest = std::max(widest, row[column].size());
    return widest;
  }
  std::string markdown_row(const std::vector<std::string>& cells) const {
    std::string text = "|";
    for (size_t column = 0; column < cells.size(); ++column)
      text += fmt::format(" {:>{}} |", cells[column], width(column));
    return text + "\n";
  }

  size_t narrowest_;
  std::vector<std::vector<std::string>> rows_;  // the first: the heads
};

}  // namespace kd::bench
