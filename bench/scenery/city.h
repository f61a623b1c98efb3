// A city of any size: two dozen meshes, blocks that place them, and a scene that lays blocks side by side.
//
// A block is a square of ground with its houses, trees, lamps and cars, a character; the scene turns, mirrors and
// stretches it upwards. Towers stand around the origin, offices around them, houses from there on, and parks between.
#pragma once

#include <string>

#include "scenery/scenery.h"

namespace kd::bench::scenery {

/// The smallest square of blocks whose instances have at least so many triangles, from kFewestTriangles to
/// kMostTriangles. The same seed gives the same city, on any machine.
Scenery lay_out_city(uint64_t triangles, uint64_t seed, const std::string& folder);

}  // namespace kd::bench::scenery
