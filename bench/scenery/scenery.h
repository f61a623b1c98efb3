// Scenes of any size, made of a few meshes: what their makers return.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "scenery/obj_mesh.h"
#include "sys/result.h"

namespace kd::bench::scenery {

struct Scenery {
  std::vector<NamedMesh> meshes;  // in the order of scene.objects
  scene::Scene scene;             // objects are FOLDER/compiled/NAME.nkd
  uint64_t instances = 0;
  uint64_t triangles = 0;  // of all instances
};

constexpr uint64_t kFewestTriangles = 10'000'000;
constexpr uint64_t kMostTriangles = 10'000'000'000;

/// What the file says of a length: rounded, so that it stays short.
inline double centimetres(double length) { return std::round(100 * length) / 100; }

/// Each mesh to FOLDER/NAME.obj, what they are made of to FOLDER/LIBRARY.mtl. Errors: ErrorClass::output, or
/// ErrorClass::interrupted between two meshes.
Result<void> write_meshes(const std::string& folder, const std::string& library, std::span<const NamedMesh> meshes);

}  // namespace kd::bench::scenery
