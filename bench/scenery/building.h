// Buildings: storeys of bays with windows, and what is on, over and before them. Feet at y = 0, fronts towards +z.
#pragma once

#include <vector>

#include "scenery/obj_mesh.h"

namespace kd::bench::scenery {

enum class Roof : uint8_t { flat, gabled };

/// One of the boxes of which a building is stacked. Metres.
struct Tier {
  double width = 0;  // along x
  double depth = 0;  // along z
  int storeys = 1;
};

/// What a building's windows are like, and its parts made of. Lengths in metres.
struct Style {
  double storey = 3.2;
  double bay = 2.4;            // about: a wall has as many as fit
  double window_width = 0.55;  // of a bay
  double window_height = 0.6;  // of a storey
  int panes_across = 2;
  int panes_up = 2;
  int balcony_every = 0;  // so many bays, 0: none
  Roof roof = Roof::flat;
  Stuff wall = Stuff::plaster;
  Stuff foot = Stuff::limestone;  // the ground floor
  Stuff trim = Stuff::limestone;  // ledges, sills and frames
};

/// `tiers` from the ground up. The first storey is higher by half, and has shops.
ObjMesh raise_building(const std::vector<Tier>& tiers, const Style& style, uint64_t seed);

}  // namespace kd::bench::scenery
