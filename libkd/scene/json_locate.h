// Locates faults and values in JSON text. FlatBuffers' parser forgives much that a scene must not hold (comments, hex
// and quoted numbers, nan, arrays in place of tables, nulls) and cannot say where a value stood once it is parsed; this
// scanner knows the schema as well, refuses what is not strict JSON of its shape, and tells line and column.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace reflection {
struct Schema;
}

namespace kd::scene {

/// Counted from 1; a column is a byte, a tab included.
struct Position {
  int line = 1;
  int column = 1;
};

struct JsonFault {
  Position at;
  std::string what;
};

/// A value as the scanner meets it.
struct JsonValue {
  std::string_view path;   // "characters[0].parts[2].scale"; empty for the root
  std::string_view table;  // the schema's full name of an object's table; empty for all other values
  Position at;
};
using JsonVisitor = std::function<void(const JsonValue&)>;

/// The first place where `json` is not strict JSON of the shape of `schema`'s root table, or nothing. Structs are
/// arrays of their numbers; numbers must fit a double or the field's integer; unknown, repeated and missing required
/// fields are faults, and so is null. Left to FlatBuffers: whether strings are UTF-8 and escaped characters exist.
/// `visit`, if given, is called with the values in the order of the text, up to a fault.
std::optional<JsonFault> locate_fault(std::string_view json, const reflection::Schema& schema,
                                      const JsonVisitor& visit = {});

/// In bytes of the text.
struct JsonSpan {
  size_t begin = 0;
  size_t end = 0;
};

/// The value at `path`, if there is one. `json` is without fault.
std::optional<JsonSpan> find_value(std::string_view json, const reflection::Schema& schema, std::string_view path);

/// Where the value at `path` stands, or, if it is absent, the innermost value around it. `json` is without fault.
Position locate(std::string_view json, const reflection::Schema& schema, std::string_view path);

}  // namespace kd::scene
