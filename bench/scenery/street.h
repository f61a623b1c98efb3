// What lies and stands between houses. The middle of a block, a lamp's foot or a car's floor is the origin; y is up.
#pragma once

#include "scenery/obj_mesh.h"

namespace kd::bench::scenery {

constexpr double kBlock = 90;      // from the middle of a street to that of the next, metres
constexpr double kRoad = 14;       // a street's width between kerbs
constexpr double kPavement = 3.5;  // and that of the pavement beside it
constexpr double kKerb = 0.15;     // how high pavements and yards are

/// A square of kBlock: the yard, pavement around it in slabs, and half of each street.
ObjMesh lay_street();
/// Grass for a yard, in soft waves.
ObjMesh lay_lawn(uint64_t seed);
ObjMesh make_lamp();
/// About 4.4 m along z.
ObjMesh make_car(Stuff paint);

}  // namespace kd::bench::scenery
