// What a glTF file's nodes place: instances of meshes, a camera, lights.
#pragma once

#include <string>
#include <vector>

#include "mesh/asset.h"
#include "mesh/gltf_file.h"

namespace kd::mesh {

/// Adds to `asset`, which has its meshes, what the default scene shows, or all nodes where there are no scenes.
/// `mesh_of`: per mesh of the file, its index in the asset or kNoIndex if it has no surface. Where no node places a
/// mesh, each stands once, as it was modelled.
///
/// The camera is the first perspective one. Lights are KHR_lights_punctual, and become ones without falloff: a
/// directional light's illuminance, and a point light's intensity over the square of its distance to the centre of what
/// is placed (no less than a tenth of its diagonal), are multiplied by one number, so that the brightest component of
/// all is 1. A spot light becomes a point light.
///
/// ErrorClass::mesh for numbers of what is not there and for nodes that are no forest.
Result<void> place_nodes(const GltfFile& file, const std::string& path, const std::vector<uint32_t>& mesh_of,
                         Asset& asset);

}  // namespace kd::mesh
