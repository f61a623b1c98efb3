// A forest of any size: a dozen meshes, plots of ground that place them, and a scene that places the plots.
//
// A plot is a square of ground with what grows on it, a character; the scene lays plots side by side, turned by
// quarters, mirrored, stretched upwards and sheared with the slope, so that trees stay upright on it.
#pragma once

#include <string>
#include <vector>

#include "forest/plots.h"
#include "scene/scene.h"

namespace kd::bench::forest {

struct Forest {
  std::vector<NamedMesh> meshes;  // in the order of scene.objects
  scene::Scene scene;             // objects are FOLDER/compiled/NAME.nkd
  uint64_t instances = 0;
  uint64_t triangles = 0;  // of all instances
};

constexpr uint64_t kFewestTriangles = 10'000'000;
constexpr uint64_t kMostTriangles = 10'000'000'000;

/// The smallest square of plots whose instances have at least so many triangles, from kFewestTriangles to
/// kMostTriangles. The same seed gives the same forest, on any machine.
Forest plant_forest(uint64_t triangles, uint64_t seed, const std::string& folder);

}  // namespace kd::bench::forest
