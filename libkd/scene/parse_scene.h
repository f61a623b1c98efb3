// Scene files: strict JSON in the shape of schema/scene.fbs, which is the format's reference.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "scene/override.h"
#include "scene/scene.h"
#include "sys/result.h"

namespace kd::scene {

/// A scene file is at most this long, in bytes: what FlatBuffers makes of more might not fit its 2 GiB.
constexpr size_t kMaxSceneBytes = size_t{1} << 27;

/// The scene that `json` describes. `path` is the file it came from: objects' files are resolved against its folder,
/// and errors start with "path:line:column". ErrorClass::scene for a text that is no scene, ErrorClass::resource if
/// there is no memory for it. Objects' files are not opened.
Result<Scene> parse_scene(std::string_view json, const std::string& path);

/// The same with values changed first. ErrorClass::usage, with the override, if it is the first that leaves no scene
/// where there was one.
Result<Scene> parse_scene(std::string_view json, const std::string& path, std::span<const Override> overrides);

/// The same of a file; ErrorClass::missing if it cannot be read.
Result<Scene> read_scene(const std::string& path, std::span<const Override> overrides = {});

}  // namespace kd::scene
