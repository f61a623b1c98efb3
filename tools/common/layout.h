// A triangle layout in an option's value.
#pragma once

#include <optional>
#include <string_view>

#include "core/object_view.h"

namespace kd::tools {

/// By the layout's name; nothing for any other text.
inline std::optional<TriangleLayout> layout_named(std::string_view name) {
  for (const TriangleLayout layout : {TriangleLayout::expanded, TriangleLayout::compact}) {
    if (name == name_of(layout)) return layout;
  }
  return std::nullopt;
}

}  // namespace kd::tools
