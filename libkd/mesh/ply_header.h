// The header of a PLY file, as far as a mesh needs it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sys/result.h"

namespace kd::mesh {

struct PlyHeader {
  struct Property {
    std::string name;
    std::string type;        // float32, float64, int8, uint8, ..., whichever of its two names the file used
    std::string count_type;  // of a list; empty for a single value
  };
  struct Element {
    std::string name;
    uint64_t count = 0;
    std::vector<Property> properties;
  };

  std::string format;  // ascii, binary_little_endian or binary_big_endian
  std::vector<Element> elements;
  size_t size = 0;     // bytes up to the data
  uint64_t lines = 0;  // lines up to the data

  bool is_text() const { return format == "ascii"; }
  const Element* find(std::string_view name) const;
};

/// Bytes of a value of this type in a binary file.
size_t ply_type_size(const std::string& type);

/// ErrorClass::mesh, with the line, for what is not a PLY header or claims more than `text`, the whole file, can hold:
/// whoever reads on may reserve memory for its counts.
Result<PlyHeader> read_ply_header(std::string_view text, const std::string& path);

}  // namespace kd::mesh
