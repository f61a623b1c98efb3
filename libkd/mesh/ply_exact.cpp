#include "mesh/ply_exact.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "mesh/text.h"

namespace kd::mesh {
namespace {

int axis_of(const PlyHeader::Property& property) {
  if (property.type != "float64" || property.name.size() != 1) return -1;
  return property.name == "x" ? 0 : property.name == "y" ? 1 : property.name == "z" ? 2 : -1;
}

void restore_text(const PlyHeader& header, std::string_view data, std::vector<Vec3d>& positions, Watch& watch) {
  Tokens tokens(data);
  for (const auto& element : header.elements) {
    const bool is_vertex = element.name == "vertex";
    for (uint64_t i = 0; i < element.count; ++i) {
      watch.step();
      for (const auto& property : element.properties) {
        const std::string_view token = tokens.next();
        const int axis = is_vertex ? axis_of(property) : -1;
        const auto value = axis >= 0 ? parse_number(token) : std::nullopt;
        if (value) positions[i].set(axis, *value);
      }
    }
    if (is_vertex) return;
  }
}

double load(const char* from, bool big_endian) {
  std::array<char, sizeof(double)> raw;
  std::memcpy(raw.data(), from, raw.size());
  if (big_endian != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<double>(raw);
}

void restore_binary(const PlyHeader& header, std::string_view data, std::vector<Vec3d>& positions, Watch& watch) {
  const bool big_endian = header.format == "binary_big_endian";
  const char* at = data.data();
  for (const auto& element : header.elements) {
    const bool is_vertex = element.name == "vertex";
    for (uint64_t i = 0; i < element.count; ++i) {
      watch.step();
      for (const auto& property : element.properties) {
        const int axis = is_vertex ? axis_of(property) : -1;
        if (axis >= 0) positions[i].set(axis, load(at, big_endian));
        at += ply_type_size(property.type);
      }
    }
    if (is_vertex) return;
  }
}

}  // namespace

void restore_doubles(const PlyHeader& header, std::string_view data, std::vector<Vec3d>& positions, Watch& watch) {
  const auto& properties = header.find("vertex")->properties;
  if (std::none_of(properties.begin(), properties.end(), [](const auto& p) { return axis_of(p) >= 0; })) return;
  return header.is_text() ? restore_text(header, data, positions, watch)
                          : restore_binary(header, data, positions, watch);
}

}  // namespace kd::mesh
