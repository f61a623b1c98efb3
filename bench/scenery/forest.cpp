#include "scenery/forest.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "scenery/directions.h"
#include "scenery/plots.h"
#include "scenery/terrain.h"

namespace kd::bench::scenery {

namespace {

constexpr double kNear = 24;      // z of the ground's edge, behind the eye
constexpr double kVerge = 14;     // how far from the path a plot's middle is, at most, if the path may cross the plot
constexpr double kTrodden = 2.4;  // how far that of a piece of grass is, at least
constexpr int kGroundCells = 320;

/// Which kind of plot belongs on this ground: grass along the path and around the eye, spruces where it is high.
PlotId plot_for(const Terrain& terrain, double x, double z, Random& random) {
  const double away = std::fabs(x - terrain.path(z)) + random.real(-4, 4);
  if (away < 18 || (std::fabs(x) < 34 && z > -40)) return meadow;
  if (away < 33) return edge;
  const double altitude = terrain.height(x, z) + random.real(-18, 18) + 14 * noise({x / 70, 0, z / 70}, 77);
  return altitude < 20 ? leafy : altitude < 48 ? mixed : dark;
}

/// A square of ground to the scene: one of the square's eight symmetries, taller or lower, on the slope.
Frame on_slope(const Terrain& terrain, double x, double z, double side, Random& random) {
  const double h = 0.5 * side;
  const double west = terrain.height(x - h, z), east = terrain.height(x + h, z);
  const double north = terrain.height(x, z - h), south = terrain.height(x, z + h);
  const auto axis = [&](double dx, double dz) {
    return Vec3d{dx, std::round(1e4 * ((east - west) * dx + (south - north) * dz) / side) / 1e4, dz};
  };
  const double sx = random.sign(), sz = random.sign(), tall = centimetres(random.real(0.85, 1.2));
  const Vec3d point{centimetres(x), centimetres(0.25 * (west + east + north + south)), centimetres(z)};
  if (random.chance(0.5)) return {point, axis(sx, 0), {0, tall, 0}, axis(0, sz)};
  return {point, axis(0, sx), {0, tall, 0}, axis(sz, 0)};
}

/// The plots of a square before the eye, and the grass beside the path.
class Layout {
 public:
  Layout(const Plots& plots, const std::vector<NamedMesh>& meshes, const Terrain& terrain, uint64_t seed)
      : plots_(plots), meshes_(meshes), terrain_(terrain), seed_(seed) {}

  void cover(int side) {
    wood.parts.clear();
    instances = triangles = 0;
    for (int row = 0; row < side; ++row) {
      for (int column = 0; column < side; ++column) {
        const double x = (column - 0.5 * (side - 1)) * kPlot, z = kNear - (row + 0.5) * kPlot;
        // A plot is what it is by where it is, however large the forest.
        Random random(seed_, static_cast<uint64_t>(row) << 32 | static_cast<uint32_t>(2 * column - side + (1 << 20)));
        if (std::fabs(x - terrain_.path(z)) < kVerge) {
          add_verge(x, z, random);
        } else {
          add_plot(x, z, random);
        }
      }
    }
  }

  scene::Character wood;
  uint64_t instances = 0;
  uint64_t triangles = 0;

 private:
  void add_plot(double x, double z, Random& random) {
    const PlotId id = plot_for(terrain_, x, z, random);
    scene::Part part;
    part.character = plots_.first[id] + random.below(plots_.first[id + 1] - plots_.first[id]);
    part.placement = scene::FramePlacement{on_slope(terrain_, x, z, kPlot, random)};
    for (const scene::Part& grown : plots_.characters[*part.character].parts) count(grown.object);
    wood.parts.push_back(std::move(part));
  }

  /// Grass beside the path, in columns that follow it.
  void add_verge(double x, double z, Random& random) {
    constexpr double kApart = 0.5 * kTurf;
    for (double row = z - 0.5 * (kPlot - kTurf); row < z + 0.5 * kPlot; row += kTurf) {
      const double middle = terrain_.path(row);
      const auto first = static_cast<int>(std::ceil((x - 0.5 * kPlot - middle) / kApart));
      const auto end = static_cast<int>(std::ceil((x + 0.5 * kPlot - middle) / kApart));
      for (int column = first; column < end; ++column) {
        if (std::abs(column) * kApart < kTrodden) continue;
        scene::Part part;
        part.object = random.chance(0.25) ? flowers : turf;
        part.placement = scene::FramePlacement{on_slope(terrain_, middle + column * kApart, row, kTurf, random)};
        count(part.object);
        wood.parts.push_back(std::move(part));
      }
    }
  }

  void count(uint32_t object) {
    ++instances;
    triangles += meshes_[object].mesh.triangle_count();
  }

  const Plots& plots_;
  const std::vector<NamedMesh>& meshes_;
  const Terrain& terrain_;
  uint64_t seed_;
};

void set_view(scene::Scene& scene, const Terrain& terrain) {
  scene.film = {1920, 1080};
  constexpr double kAhead = -110;
  const double x = terrain.path(0) - 2.5, ahead = terrain.path(kAhead);
  scene.camera.position = {centimetres(x), centimetres(terrain.height(x, 0) + 3), 0};
  scene.camera.target = {centimetres(ahead), centimetres(terrain.height(ahead, kAhead) + 10), kAhead};
  scene.camera.vertical_fov_degrees = 42;
  scene.background = {0.55f, 0.72f, 0.92f};
  scene.ambient = {0.27f, 0.33f, 0.42f};
  scene::Light sun;
  sun.kind = scene::LightKind::directional;
  sun.direction = normalised(Vec3d{0.85, -0.62, -0.12});
  sun.colour = {1.9f, 1.7f, 1.3f};
  scene.lights.push_back(sun);
}

}  // namespace

Scenery plant_forest(uint64_t triangles, uint64_t seed, const std::string& folder) {
  Scenery forest;
  forest.meshes = grow_meshes(seed);
  const Terrain terrain(seed);
  Plots plots = plant_plots(seed);
  Layout layout(plots, forest.meshes, terrain, seed);
  // Sides are even, so that larger forests have the plots of smaller ones where these have them.
  int side = 4;
  layout.cover(side);
  while (layout.triangles < triangles) layout.cover(side += 2);

  const double half = 0.5 * side * kPlot;
  forest.meshes.push_back({"ground", terrain.mesh(half, kNear, std::min(kGroundCells, 8 * side))});
  forest.meshes.push_back({"path", terrain.path_mesh(kNear, kNear - 2 * half)});
  scene::Character floor;
  floor.name = "floor";
  for (const Kind kind : {ground, path}) {
    scene::Part part;
    part.object = kind;
    floor.parts.push_back(std::move(part));
    layout.triangles += forest.meshes[kind].mesh.triangle_count();
  }
  forest.instances = layout.instances + floor.parts.size();
  forest.triangles = layout.triangles;

  scene::Scene& scene = forest.scene;
  for (const NamedMesh& mesh : forest.meshes)
    scene.objects.push_back({mesh.name, fmt::format("{}/compiled/{}.nkd", folder, mesh.name)});
  scene.characters = std::move(plots.characters);
  layout.wood.name = "wood";
  scene.characters.push_back(std::move(layout.wood));
  scene.characters.push_back(std::move(floor));
  set_view(scene, terrain);
  return forest;
}

}  // namespace kd::bench::scenery
