#include "nkd/issues.h"

#include <fmt/format.h>

namespace kd::nkd {

std::string_view issue_text(Issue issue) {
  for (const IssueRow& row : kIssues) {
    if (row.issue == issue) return row.text;
  }
  return "unknown issue";
}

std::string Finding::line() const {
  const std::string text = fmt::format("NKD{}: {}", static_cast<int>(issue), issue_text(issue));
  return detail.empty() ? text : fmt::format("{} ({})", text, detail);
}

}  // namespace kd::nkd
