// What grows and lies between trees.
#pragma once

#include "scenery/obj_mesh.h"

namespace kd::bench::scenery {

/// A square of grass, `side` metres wide, its middle at the origin; one blade in `per_flower` has petals (0: none).
ObjMesh grow_turf(double side, int blades, int per_flower, uint64_t seed);

ObjMesh grow_fern(uint64_t seed);

/// A boulder of about a metre and a half around the origin: 12 cells^2 flat triangles.
ObjMesh make_rock(int cells, uint64_t seed);

}  // namespace kd::bench::scenery
