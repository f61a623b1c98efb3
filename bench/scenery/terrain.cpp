#include "scenery/terrain.h"

#include <cmath>

#include "scenery/directions.h"

namespace kd::bench::scenery {

double Terrain::path(double z) const {
  return 55 * noise({z / 130, 0.5, 0}, seed_ + 1) * smooth_step(0, -90, z) + 7 * noise({z / 33, 0.5, 0}, seed_ + 2);
}

double Terrain::height(double x, double z) const {
  const double away = std::fabs(x - path(z));
  const double slope = 66 * smooth_step(8, 230, away) + 0.06 * std::fmax(away - 200, 0);
  const double head = 75 * smooth_step(-380, -1000, z);  // where the valley ends
  const double knoll = 12 * smooth_step(-75, -5, z) * smooth_step(70, 20, away);
  const double hills = 11 * noise({x / 120, 0, z / 120}, seed_ + 3) * smooth_step(10, 120, away);
  return slope + head + knoll + hills + 0.5 * noise({x / 45, 0, z / 45}, seed_ + 4);
}

Vec3d Terrain::normal(double x, double z) const {
  constexpr double kReach = 1;
  return {height(x - kReach, z) - height(x + kReach, z), 2 * kReach, height(x, z - kReach) - height(x, z + kReach)};
}

ObjMesh Terrain::mesh(double half, double near, int cells) const {
  ObjMesh mesh;
  const double cell = 2 * half / cells;
  std::vector<Corner> corners;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const double x = i * cell - half, z = near - j * cell;
      corners.push_back({mesh.vertex({x, height(x, z), z}), mesh.normal(normal(x, z))});
    }
  }
  Random random(seed_, 5);
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const double away = std::fabs((i + 0.5) * cell - half - path(near - (j + 0.5) * cell));
      const Stuff wood = random.chance(0.5) ? Stuff::soil : Stuff::moss;
      const Stuff stuff = random.chance(smooth_step(30, 16, away)) ? Stuff::meadow : wood;
      const auto at = [&](int di, int dj) { return corners[static_cast<size_t>((j + dj) * (cells + 1) + i + di)]; };
      mesh.quad(stuff, at(0, 0), at(1, 0), at(1, 1), at(0, 1));
    }
  }
  return mesh;
}

ObjMesh Terrain::path_mesh(double near, double far) const {
  ObjMesh mesh;
  constexpr double kStep = 0.5;
  constexpr double kProfile[][2] = {{-1.5, -0.3}, {-1.1, 0.05}, {-0.4, 0.09}, {0.4, 0.09}, {1.1, 0.05}, {1.5, -0.3}};
  const int rows = static_cast<int>((near - far) / kStep);
  std::vector<Corner> last, next(std::size(kProfile));
  for (int row = 0; row <= rows; ++row) {
    const double z = near - row * kStep;
    for (size_t i = 0; i < next.size(); ++i) {
      const double ragged = 0.25 * noise({z / 1.7, kProfile[i][0], 0}, seed_ + 6);
      const double x = path(z) + kProfile[i][0] + ragged;
      next[i] = {mesh.vertex({x, height(x, z) + kProfile[i][1], z}), mesh.normal(normal(x, z))};
    }
    for (size_t i = 0; i + 1 < last.size(); ++i) mesh.quad(Stuff::path, last[i], last[i + 1], next[i + 1], next[i]);
    last = next;
  }
  return mesh;
}

}  // namespace kd::bench::scenery
