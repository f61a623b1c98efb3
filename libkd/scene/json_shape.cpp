#include "scene/json_shape.h"

#include <algorithm>

namespace kd::scene {

Shape root_shape(const reflection::Schema& schema) {
  const auto& objects = *schema.objects();
  const auto name = schema.root_table()->name()->string_view();
  const auto root = std::find_if(objects.begin(), objects.end(),
                                 [&](const reflection::Object* o) { return o->name()->string_view() == name; });
  return {reflection::Obj, reflection::None, static_cast<int>(root - objects.begin())};
}

const reflection::Object* object_of(const reflection::Schema& schema, const Shape& shape) {
  if (shape.base != reflection::Obj) return nullptr;
  return schema.objects()->Get(static_cast<flatbuffers::uoffset_t>(shape.index));
}

Shape shape_of(const reflection::Field& field) {
  return {field.type()->base_type(), field.type()->element(), field.type()->index()};
}

const reflection::Field* find_field(const reflection::Object& table, std::string_view name) {
  for (const reflection::Field* field : *table.fields()) {
    if (field->name()->string_view() == name) return field;
  }
  return nullptr;
}

std::string field_names(const reflection::Object& table) {
  std::string names;
  for (const reflection::Field* field : *table.fields()) names += (names.empty() ? "" : ", ") + field->name()->str();
  return names;
}

}  // namespace kd::scene
