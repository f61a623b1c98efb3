// What kdrender writes into an EXR's header.
#pragma once

#include <string>

#include "image/exr.h"
#include "render/load.h"
#include "scene/scene.h"

namespace kd::tools {

/// How the camera sees the film: OpenEXR's standard attributes of these names.
image::Matrix4 world_to_camera(const scene::Camera& camera);
image::Matrix4 world_to_ndc(const scene::Camera& camera, const scene::FilmSize& film);

/// Of the compiled objects that a scene places, loaded or not: the same if they were made by the same settings from
/// sources of the same content.
std::string objects_hash(const render::LoadedScene& scene);

}  // namespace kd::tools
