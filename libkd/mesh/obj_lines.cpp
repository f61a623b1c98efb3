#include "mesh/obj_lines.h"

#include <algorithm>

namespace kd::mesh {
namespace {

/// Takes a line off the front of `text`; line breaks are LF, CR LF or CR and do not belong to it.
std::string_view take_line(std::string_view& text) {
  const size_t length = std::min(text.find_first_of("\r\n"), text.size());
  const std::string_view line = text.substr(0, length);
  const bool is_pair = text.substr(length).starts_with("\r\n");
  text.remove_prefix(std::min(length + (is_pair ? 2 : 1), text.size()));
  return line;
}

std::string_view without_indent(std::string_view line) {
  return line.substr(std::min(line.find_first_not_of(" \t"), line.size()));
}

bool is_comment(std::string_view line) { return without_indent(line).starts_with('#'); }

/// Whether a # in the statement can only be a comment: numbers follow, and no names.
bool has_numbers(std::string_view statement) {
  statement = without_indent(statement);
  const std::string_view keyword = statement.substr(0, statement.find_first_of(" \t"));
  return keyword == "f" || keyword == "v" || keyword == "vn" || keyword == "vt";
}

}  // namespace

std::string plain_obj_lines(std::string_view text, Watch& watch) {
  std::string out;
  out.reserve(text.size() + 1);
  while (!text.empty()) {
    watch.step();
    const size_t start = out.size();
    std::string_view line = take_line(text);
    size_t joined = 0;
    if (!is_comment(line)) {
      while (line.ends_with('\\')) {
        out += line.substr(0, line.size() - 1);
        out += ' ';
        bool more = true;
        for (line = {}; more && !text.empty(); ++joined) {
          line = take_line(text);
          more = is_comment(line);
          if (more) line = {};
        }
      }
      out += line;
      const std::string_view statement = std::string_view(out).substr(start);
      if (has_numbers(statement)) out.resize(start + std::min(statement.find('#'), statement.size()));
      if (without_indent(statement) == "g") out += ' ';
    }
    out.append(joined + 1, '\n');
  }
  return out;
}

}  // namespace kd::mesh
