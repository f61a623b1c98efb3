// What a schema expects of JSON values.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <flatbuffers/reflection_generated.h>

#include "scene/json_locate.h"

namespace kd::scene {

/// reflection::Type without its vector, so that elements have a shape too.
struct Shape {
  reflection::BaseType base;
  reflection::BaseType element;  // of a vector
  int index;                     // of the table, struct or enumeration; -1 if none
};

Shape root_shape(const reflection::Schema& schema);

/// The table, or the struct, that a value of this shape is; null for others.
const reflection::Object* object_of(const reflection::Schema& schema, const Shape& shape);

Shape shape_of(const reflection::Field& field);

/// Null if the table has none of this name.
const reflection::Field* find_field(const reflection::Object& table, std::string_view name);

/// "a, b, c", for who asked for another.
std::string field_names(const reflection::Object& table);

/// The first place where `value` alone is not strict JSON of this shape, or nothing.
std::optional<JsonFault> find_fault(std::string_view value, const reflection::Schema& schema, const Shape& shape);

}  // namespace kd::scene
