// The JSON of a glTF file: where it is in the file, how deep it may be, and which of its values count.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "mesh/formats.h"

namespace kd::mesh {

/// The JSON, and the bytes of the first buffer if it is in the same file.
struct GltfContainer {
  Bytes json;
  std::optional<Bytes> binary;
};

/// ErrorClass::mesh, or nothing but JSON if `bytes` are no GLB container.
Result<GltfContainer> open_container(Bytes bytes, const std::string& path);

/// The JSON's root, an object. ErrorClass::mesh for what is no JSON, or too deep: a parser descends as deep as it is.
/// Throws Cancelled.
Result<nlohmann::json> parse_gltf_json(std::string_view text, const std::string& path, Watch& watch);

/// Leaves of the root what is read of it. Returns what is of another kind than glTF says, with its JSON pointer (RFC
/// 6901); or nothing.
std::string keep_what_is_read(nlohmann::json& root);

/// An error of a glTF file. What is wrong may repeat names of the file: cut short, and made one line.
Error gltf_error(const std::string& path, std::string what);

}  // namespace kd::mesh
