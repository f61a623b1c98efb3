// A forest of any size: a dozen meshes, plots of ground that place them, and a scene that places the plots.
//
// A plot is a square of ground with what grows on it, a character; the scene lays plots side by side, turned by
// quarters, mirrored, stretched upwards and sheared with the slope, so that trees stay upright on it.
#pragma once

#include <string>

#include "scenery/scenery.h"

namespace kd::bench::scenery {

/// The smallest square of plots whose instances have at least so many triangles, from kFewestTriangles to
/// kMostTriangles. The same seed gives the same forest, on any machine.
Scenery plant_forest(uint64_t triangles, uint64_t seed, const std::string& folder);

}  // namespace kd::bench::scenery
