#include "kdbuild/depfile.h"

#include <algorithm>

namespace kd::tools {

namespace {

std::string escaped(const std::string& name) {
  std::string out;
  size_t backslashes = 0;  // that end `out`
  for (const char c : name) {
    if (c == ' ' || c == '\t' || c == '#' || c == ':') out.append(backslashes + 1, '\\');
    if (c == '$') out += '$';
    out += c;
    backslashes = c == '\\' ? backslashes + 1 : 0;
  }
  return out;
}

bool has_line_break(const std::string& name) { return name.find_first_of("\r\n") != std::string::npos; }

}  // namespace

std::string depfile_text(const std::vector<Dependencies>& rules) {
  std::string text;
  for (const Dependencies& rule : rules) {
    if (has_line_break(rule.output) || std::any_of(rule.inputs.begin(), rule.inputs.end(), has_line_break)) continue;
    text.append(escaped(rule.output)).append(1, ':');
    for (const std::string& input : rule.inputs) text.append(1, ' ').append(escaped(input));
    text += '\n';
  }
  return text;
}

}  // namespace kd::tools
