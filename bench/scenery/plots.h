// The meshes of a forest, and plots of ground on which they grow.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "scenery/obj_mesh.h"

namespace kd::bench::scenery {

/// Objects, in the order in which they are made. The last two are the terrain's.
enum Kind : uint32_t {
  beech,
  old_beech,
  birch,
  autumn,
  spruce,
  young_spruce,
  pine,
  shrub,
  fern,
  turf,
  flowers,
  rock,
  ground,
  path,
};

/// Those of all kinds but the terrain's.
std::vector<NamedMesh> grow_meshes(uint64_t seed);

constexpr double kPlot = 16;   // a plot's side, metres
constexpr double kTurf = 3.2;  // and that of a piece of grass

enum PlotId { meadow, edge, leafy, mixed, dark };

/// Several plots of each PlotId, as characters that are not shown of themselves.
struct Plots {
  std::vector<scene::Character> characters;
  std::vector<uint32_t> first;  // one a PlotId, and the end: its plots in `characters`
};
Plots plant_plots(uint64_t seed);

}  // namespace kd::bench::scenery
