#include "scenery/plots.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenery/directions.h"
#include "scenery/scenery.h"
#include "scenery/tree.h"
#include "scenery/undergrowth.h"

namespace kd::bench::scenery {

namespace {

struct Planting {
  Kind kind;
  int count;
  double smallest, largest;  // scale
  double apart;              // metres, from what else needs room
};

/// A kind of plot: what grows there, the tallest first, and how many different ones there are.
struct PlotKind {
  const char* name;
  int variants;
  bool grass;
  std::vector<Planting> plantings;
};

std::vector<PlotKind> plot_kinds() {
  return {
      {"meadow", 3, true, {{rock, 1, 0.2, 0.7, 1}, {shrub, 1, 0.4, 0.8, 1}}},
      {"edge",
       3,
       true,
       {{birch, 1, 0.7, 1.1, 4},
        {autumn, 1, 0.6, 1, 4},
        {young_spruce, 1, 0.5, 1, 4},
        {shrub, 5, 0.7, 1.4, 1.5},
        {rock, 1, 0.4, 1.2, 1}}},
      {"leafy",
       4,
       false,
       {{old_beech, 2, 0.85, 1.15, 5},
        {beech, 3, 0.8, 1.15, 4},
        {birch, 1, 0.9, 1.2, 3},
        {autumn, 1, 0.8, 1.15, 3},
        {shrub, 4, 0.7, 1.3, 1.5},
        {fern, 12, 0.8, 1.5, 0.6}}},
      {"mixed",
       4,
       false,
       {{beech, 3, 0.8, 1.2, 4},
        {spruce, 2, 0.7, 1.1, 3.5},
        {pine, 1, 0.85, 1.15, 3.5},
        {birch, 1, 0.9, 1.2, 3},
        {shrub, 2, 0.7, 1.2, 1.5},
        {fern, 10, 0.8, 1.5, 0.6},
        {rock, 1, 0.5, 1.5, 1}}},
      {"dark",
       4,
       false,
       {{spruce, 5, 0.7, 1.15, 3.2},
        {pine, 2, 0.85, 1.15, 3},
        {young_spruce, 2, 0.6, 1.1, 2.5},
        {fern, 8, 0.7, 1.3, 0.6},
        {rock, 1, 0.6, 1.8, 1}}},
  };
}

scene::Part part_of(Kind kind, double x, double z, Random& random, double scale) {
  scene::Part part;
  part.object = kind;
  const double y = kind == rock ? 0.1 : 0;
  part.placement = scene::TransformPlacement{.translate = {x, y, z},
                                             .rotate_axis = kUp,
                                             .rotate_degrees = static_cast<double>(random.below(360)),
                                             .scale = {scale, scale, scale}};
  return part;
}

scene::Character plant_plot(const PlotKind& kind, int variant, uint64_t seed) {
  Random random(seed, 0);
  scene::Character plot;
  plot.name = fmt::format("{}_{}", kind.name, variant);
  plot.shown = false;
  struct Place {
    double x, z, apart;
  };
  std::vector<Place> taken;
  const auto room = [&](double x, double z, double apart) {
    return std::none_of(taken.begin(), taken.end(), [&](const Place& p) {
      const double dx = x - p.x, dz = z - p.z, least = 0.5 * (apart + p.apart);
      return dx * dx + dz * dz < least * least;
    });
  };
  for (const Planting& planting : kind.plantings) {
    for (int i = 0; i < planting.count; ++i) {
      for (int attempt = 0; attempt < 40; ++attempt) {
        const double x = centimetres(random.real(-0.49, 0.49) * kPlot);
        const double z = centimetres(random.real(-0.49, 0.49) * kPlot);
        if (!room(x, z, planting.apart)) continue;
        taken.push_back({x, z, planting.apart});
        const double scale = centimetres(random.real(planting.smallest, planting.largest));
        plot.parts.push_back(part_of(planting.kind, x, z, random, scale));
        break;
      }
    }
  }
  if (!kind.grass) return plot;
  constexpr int kTurfs = static_cast<int>(kPlot / kTurf);
  for (int i = 0; i < kTurfs * kTurfs; ++i) {
    const double x = (i % kTurfs + 0.5) * kTurf - 0.5 * kPlot, z = (i / kTurfs + 0.5) * kTurf - 0.5 * kPlot;
    const Kind grass = random.chance(0.25) ? flowers : turf;
    scene::Part part = part_of(grass, centimetres(x), centimetres(z), random, 1);
    std::get<scene::TransformPlacement>(part.placement).rotate_degrees = 90 * random.below(4);
    plot.parts.push_back(std::move(part));
  }
  return plot;
}

}  // namespace

std::vector<NamedMesh> grow_meshes(uint64_t seed) {
  std::vector<NamedMesh> meshes;
  const auto add = [&](const char* name, ObjMesh mesh) { meshes.push_back({name, std::move(mesh)}); };
  add("beech", grow_tree({.height = 16, .radius = 0.3}, seed + 10));
  add("old_beech", grow_tree({.height = 21,
                              .radius = 0.48,
                              .bare = 0.2,
                              .branches = 20,
                              .reach = 0.4,
                              .rise = 0.4,
                              .forks = 10,
                              .leaves = 20},
                             seed + 11));
  add("birch", grow_tree({.height = 15,
                          .radius = 0.16,
                          .bare = 0.3,
                          .branches = 18,
                          .reach = 0.22,
                          .rise = 0.1,
                          .forks = 8,
                          .leaves = 16,
                          .leaf_length = 0.15,
                          .leaf_width = 0.1,
                          .bark = Stuff::pale_bark,
                          .foliage = Stuff::birch},
                         seed + 12));
  add("autumn",
      grow_tree({.height = 13, .radius = 0.24, .bare = 0.18, .branches = 15, .reach = 0.38, .foliage = Stuff::autumn},
                seed + 13));
  add("spruce", grow_spruce(24, seed + 14));
  add("young_spruce", grow_spruce(11, seed + 15));
  add("pine", grow_tree({.height = 20,
                         .radius = 0.27,
                         .bare = 0.62,
                         .branches = 14,
                         .reach = 0.2,
                         .rise = 0.5,
                         .forks = 8,
                         .leaves = 26,
                         .leaf_length = 0.24,
                         .leaf_width = 0.05,
                         .bark = Stuff::red_bark,
                         .foliage = Stuff::pine},
                        seed + 16));
  add("shrub", grow_shrub({.height = 1.5,
                           .radius = 0.03,
                           .rise = 0.3,
                           .forks = 8,
                           .twigs = 6,
                           .leaves = 8,
                           .leaf_length = 0.12,
                           .leaf_width = 0.07,
                           .foliage = Stuff::shrub},
                          12, seed + 17));
  add("fern", grow_fern(seed + 18));
  add("turf", grow_turf(kTurf, 4500, 0, seed + 19));
  add("flowers", grow_turf(kTurf, 4000, 40, seed + 20));
  add("rock", make_rock(24, seed + 21));
  return meshes;
}

Plots plant_plots(uint64_t seed) {
  Plots plots;
  for (const PlotKind& kind : plot_kinds()) {
    plots.first.push_back(static_cast<uint32_t>(plots.characters.size()));
    for (int variant = 0; variant < kind.variants; ++variant)
      plots.characters.push_back(plant_plot(kind, variant, seed + 100 + plots.characters.size()));
  }
  plots.first.push_back(static_cast<uint32_t>(plots.characters.size()));
  return plots;
}

}  // namespace kd::bench::scenery
