// The table of AOVs (arbitrary output variables): what a render can write beside its colour, under which channel names.
// To add one is one row here, and the stage that fills it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "sys/result.h"

namespace kd::image {

enum class Aov : uint8_t { depth, normal, position, object, instance, primitive, bary, visits };

enum class ChannelType : uint8_t { float32, uint32 };

struct AovRow {
  Aov aov;
  std::string_view name;  // as --aov takes it
  ChannelType type;       // of every component
  int components;
  std::array<std::string_view, 3> channels;  // in the EXR, the first `components` of them
  std::string_view meaning;
  std::string_view miss;  // what a pixel that meets nothing holds, in every component
};

/// In the order of Aov.
inline constexpr std::array<AovRow, 8> kAovRows{{
    {Aov::depth, "depth", ChannelType::float32, 1, {"Z"}, "distance from the viewer along the ray, scene units", "inf"},
    {Aov::normal,
     "normal",
     ChannelType::float32,
     3,
     {"N.X", "N.Y", "N.Z"},
     "shading normal, scene space, length 1",
     "0"},
    {Aov::position, "position", ChannelType::float32, 3, {"P.X", "P.Y", "P.Z"}, "hit point, scene space", "0"},
    {Aov::object, "object", ChannelType::uint32, 1, {"objectId"}, "index of the object in the scene", "0xffffffff"},
    {Aov::instance, "instance", ChannelType::uint32, 1, {"instanceId"}, "index of the instance", "0xffffffff"},
    {Aov::primitive, "primitive", ChannelType::uint32, 1, {"primitiveId"}, "number of the triangle", "0xffffffff"},
    {Aov::bary, "bary", ChannelType::float32, 2, {"bary.u", "bary.v"}, "barycentric coordinates in the triangle", "0"},
    {Aov::visits,
     "visits",
     ChannelType::uint32,
     2,
     {"visits.nodes", "visits.triangles"},
     "inner nodes visited and triangles tested for the ray",
     "the same"},
}};

constexpr const AovRow& aov_row(Aov aov) { return kAovRows[static_cast<size_t>(aov)]; }

static_assert([] {
  for (size_t i = 0; i < kAovRows.size(); ++i) {
    if (static_cast<size_t>(kAovRows[i].aov) != i) return false;
  }
  return true;
}());

/// Names separated by commas, such as "depth,normal", in the order given, repeated ones once. ErrorClass::usage, with
/// the names there are, if one is unknown or empty. An empty text asks for none.
Result<std::vector<Aov>> parse_aovs(std::string_view names);

}  // namespace kd::image
