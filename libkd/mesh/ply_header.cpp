#include "mesh/ply_header.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "mesh/text.h"

namespace kd::mesh {
namespace {

struct Type {
  const char* old_name;
  const char* name;
  size_t size;
};

constexpr std::array kTypes{Type{"char", "int8", 1},     Type{"uchar", "uint8", 1},   Type{"short", "int16", 2},
                            Type{"ushort", "uint16", 2}, Type{"int", "int32", 4},     Type{"uint", "uint32", 4},
                            Type{"float", "float32", 4}, Type{"double", "float64", 8}};

/// The newer name of a type, which says its size; empty for what is no type.
std::string type_name(std::string_view name) {
  for (const Type& type : kTypes) {
    if (name == type.old_name || name == type.name) return type.name;
  }
  return {};
}

/// The fewest bytes one of these elements can take: in text, every value is a character and a space.
uint64_t least_size(const PlyHeader::Element& element, bool text) {
  uint64_t size = 0;
  for (const auto& property : element.properties) {
    size += text ? 2 : ply_type_size(property.count_type.empty() ? property.type : property.count_type);
  }
  return size;
}

/// One line of the header into `header`. Returns what is wrong with it, or nothing.
std::string take_line(Tokens& tokens, std::string_view keyword, PlyHeader& header) {
  if (keyword == "format") {
    header.format = tokens.next_in_line();
    const bool known =
        header.is_text() || header.format == "binary_little_endian" || header.format == "binary_big_endian";
    return known ? "" : fmt::format("unknown format '{}'", header.format);
  }
  if (keyword == "element") {
    const std::string name(tokens.next_in_line());
    const auto count = parse_count(tokens.next_in_line());
    if (!count) return fmt::format("element '{}' has no count", name);
    if (header.find(name)) return fmt::format("element '{}' is there twice", name);
    header.elements.push_back({name, *count, {}});
    return "";
  }
  if (keyword == "property") {
    if (header.elements.empty()) return "a property before any element";
    PlyHeader::Property property;
    std::string_view type = tokens.next_in_line();
    if (type == "list") {
      property.count_type = type_name(tokens.next_in_line());
      if (property.count_type.empty() || property.count_type.starts_with("float")) return "a list without a count type";
      type = tokens.next_in_line();
    }
    property.type = type_name(type);
    if (property.type.empty()) return fmt::format("unknown type '{}'", type);
    property.name = tokens.next_in_line();
    header.elements.back().properties.push_back(property);
    return "";
  }
  const bool ignored = keyword.empty() || keyword == "comment" || keyword == "obj_info";
  return ignored ? "" : fmt::format("unknown header line '{}'", keyword.substr(0, 40));
}

}  // namespace

const PlyHeader::Element* PlyHeader::find(std::string_view name) const {
  const auto found = std::find_if(elements.begin(), elements.end(), [&](const Element& e) { return e.name == name; });
  return found == elements.end() ? nullptr : &*found;
}

size_t ply_type_size(const std::string& type) {
  for (const Type& t : kTypes) {
    if (type == t.name) return t.size;
  }
  return 0;
}

Result<PlyHeader> read_ply_header(std::string_view text, const std::string& path) {
  Tokens tokens(text);
  const auto failed = [&](const std::string& what) {
    return Error{ErrorClass::mesh, fmt::format("{}:{}", path, tokens.line()),
                 fmt::format("{}; not a PLY file, or a damaged one: export it again", what)};
  };
  PlyHeader header;
  if (tokens.next_in_line() != "ply") return failed("the first line is not 'ply'");
  for (;;) {
    if (!tokens.next_line()) return failed("the header has no end_header");
    const std::string_view keyword = tokens.next_in_line();
    if (keyword == "end_header") break;
    if (std::string fault = take_line(tokens, keyword, header); !fault.empty()) return failed(fault);
  }
  if (header.format.empty()) return failed("no format line");
  // The data starts after the line feed; a lone carriage return before binary data would be ambiguous.
  const size_t end = text.find('\n', tokens.offset());
  if (end == std::string_view::npos) return failed("nothing after end_header");
  header.size = end + 1;
  header.lines = tokens.line();

  const uint64_t available = text.size() - header.size;
  uint64_t needed = 0;
  for (const auto& element : header.elements) {
    const uint64_t least = std::max<uint64_t>(least_size(element, header.is_text()), 1);
    if (element.count > available / least + 1 || (needed += element.count * least) > available + 1) {
      return failed(fmt::format("{} elements '{}' cannot be in the {} bytes of data: truncated", element.count,
                                element.name, available));
    }
    if (element.name == "face") break;
  }
  return header;
}

}  // namespace kd::mesh
