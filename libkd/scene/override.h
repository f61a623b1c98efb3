// Overrides: values of a scene file changed before it is read, for a command line's "camera.vertical_fov=35".
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "sys/result.h"

namespace kd::scene {

struct Override {
  std::string path;   // as errors write it: "characters[0].parts[2].translate"
  std::string value;  // JSON: "[0, 1, 0]", "35", "\"smooth\""
};

/// "path=value"; ErrorClass::usage if there is no path or no value.
Result<Override> parse_override(std::string_view text);

/// `json`, a scene's text, with the values in their places, one after the other. A value that the text lacks is added,
/// and so are the objects around it, but no elements of arrays. ErrorClass::usage, with the override, for a path that
/// the schema does not have, an index beyond the array's end and a value that is not JSON of the schema's type. Whether
/// the scene can still be read shows when it is.
///
/// `json` is strict JSON of the schema's shape.
Result<std::string> apply_overrides(std::string json, std::span<const Override> overrides);

}  // namespace kd::scene
