// The scene of a source that is not one mesh: its objects where the source has its meshes, under its camera and lights.
#pragma once

#include <string>
#include <vector>

#include "core/box.h"
#include "mesh/asset.h"
#include "scene/scene.h"

namespace kd::tools {

struct SceneMember {
  std::string name;
  std::string file;
  uint32_t mesh = 0;  // of the asset; several objects may be pieces of one
  Box3d box;          // model space
};

/// One character, `name`, with a part for each instance of each object. Instances of a mesh without object are left
/// out. What the asset lacks is added: a camera that sees all, and a light.
scene::Scene asset_scene(const mesh::Asset& asset, const std::string& name, const std::vector<SceneMember>& members);

}  // namespace kd::tools
