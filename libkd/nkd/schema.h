// The generated FlatBuffers code of the object, and that its structs are those of core/. Only this room includes it.
#pragma once

#include <span>

#include "core/material.h"
#include "core/node.h"
#include "core/object_view.h"
#include "nkd_generated.h"

namespace kd::nkd {

static_assert(sizeof(nkd_schema::Node) == sizeof(Node));
static_assert(sizeof(nkd_schema::Float3) == sizeof(Vec3f));
static_assert(sizeof(nkd_schema::Material) == sizeof(Material));
static_assert(sizeof(nkd_schema::Triangle) == 3 * sizeof(uint32_t));
static_assert(static_cast<int>(nkd_schema::VertexForm::float32) == static_cast<int>(VertexForm::float32));

/// A vector of schema elements as the span of core's type that has the same bytes.
template <class To, class Stored>
std::span<const To> section(const flatbuffers::Vector<Stored>* v) {
  if (!v) return {};
  return {reinterpret_cast<const To*>(v->Data()),
          v->size() * (sizeof(typename std::remove_pointer_t<Stored>) / sizeof(To))};
}

}  // namespace kd::nkd
