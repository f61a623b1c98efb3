#include "scenery/street.h"

#include <cmath>

#include "scenery/boxes.h"
#include "scenery/directions.h"

namespace kd::bench::scenery {

ObjMesh lay_street() {
  ObjMesh mesh;
  const double edge = kBlock / 2, kerb = edge - kRoad / 2, yard = kerb - kPavement;
  const WallFrame ground{{0, 0, 0}};
  add_box(mesh, Stuff::asphalt, ground, {-edge, edge, 0, 0, -edge, edge}, kTop);
  add_box(mesh, Stuff::concrete, ground, {-kerb, kerb, 0, kKerb, -kerb, kerb}, kStanding);
  // Slabs lie a little higher, with gaps between them.
  constexpr double kSlab = 0.7, kGap = 0.03, kHigh = 0.03;
  const int slabs = static_cast<int>(2 * kerb / kSlab);
  for (int j = 0; j < slabs; ++j) {
    for (int i = 0; i < slabs; ++i) {
      const double x = -kerb + i * kSlab, z = -kerb + j * kSlab;
      if (std::fmax(std::fabs(x + kSlab / 2), std::fabs(z + kSlab / 2)) < yard) continue;
      add_box(mesh, Stuff::paving, ground, {x + kGap, x + kSlab, kKerb, kKerb + kHigh, z + kGap, z + kSlab}, kStanding);
    }
  }
  // Each quarter turn has one side's markings: a dashed line in the middle of the street, bars to walk on across it.
  const Vec3d ways[] = {{1, 0, 0}, {0, 0, -1}, {-1, 0, 0}, {0, 0, 1}};
  for (int side = 0; side < 4; ++side) {
    const WallFrame f{{0, 0, 0}, ways[side], ways[(side + 3) % 4]};
    const auto mark = [&](double a0, double a1, double o0, double o1) {
      add_box(mesh, Stuff::paint, f, {a0, a1, 0, 0.012, o0, o1}, kStanding);
    };
    for (double a = -kerb + 6; a + 2 < kerb - 6; a += 4) mark(a, a + 2, edge - 0.14, edge - 0.02);
    for (double o = kerb + 0.5; o + 0.5 < edge; o += 1) mark(kerb - 4.5, kerb - 1.5, o, o + 0.5);
  }
  return mesh;
}

ObjMesh lay_lawn(uint64_t seed) {
  ObjMesh mesh;
  constexpr int kCells = 40;
  const double half = kBlock / 2 - kRoad / 2 - kPavement, cell = 2 * half / kCells;
  const auto height = [&](double x, double z) {
    const double in = smooth_step(half, 0.8 * half, std::fmax(std::fabs(x), std::fabs(z)));
    return kKerb + 0.02 + in * (1.2 + 1.2 * noise({x / 17, 0, z / 17}, seed));
  };
  std::vector<Corner> corners;
  for (int j = 0; j <= kCells; ++j) {
    for (int i = 0; i <= kCells; ++i) {
      const double x = i * cell - half, z = j * cell - half;
      corners.push_back({mesh.vertex({x, height(x, z), z}),
                         mesh.normal({height(x - 1, z) - height(x + 1, z), 2, height(x, z - 1) - height(x, z + 1)})});
    }
  }
  for (int j = 0; j < kCells; ++j) {
    for (int i = 0; i < kCells; ++i) {
      const auto at = [&](int di, int dj) { return corners[static_cast<size_t>((j + dj) * (kCells + 1) + i + di)]; };
      const bool walk = std::abs(i - j) < 2 || std::abs(i + j - kCells + 1) < 2;
      mesh.quad(walk ? Stuff::path : Stuff::meadow, at(0, 0), at(0, 1), at(1, 1), at(1, 0));
    }
  }
  return mesh;
}

ObjMesh make_lamp() {
  ObjMesh mesh;
  const WallFrame f{{0, 0, 0}};
  const auto post = [&](double half, double y0, double y1) {
    add_box(mesh, Stuff::iron, f, {-half, half, y0, y1, -half, half}, kAll);
  };
  post(0.16, 0, 0.5);
  post(0.09, 0.5, 1.2);
  post(0.06, 1.2, 5.6);
  for (int i = 0; i < 6; ++i) post(0.12 + 0.03 * i, 5.6 + 0.04 * i, 5.64 + 0.04 * i);
  for (const double hand : {-1.0, 1.0}) {
    add_box(mesh, Stuff::paint, f, {hand * 0.12 - 0.09, hand * 0.12 + 0.09, 5.84, 6.25, -0.14, 0.14}, kUpright);
  }
  add_box(mesh, Stuff::iron, f, {-0.28, 0.28, 6.25, 6.32, -0.22, 0.22}, kAll);
  add_box(mesh, Stuff::iron, f, {-0.1, 0.1, 6.32, 6.45, -0.08, 0.08}, kAll);
  return mesh;
}

ObjMesh make_car(Stuff paint) {
  ObjMesh mesh;
  // The outline from the side, front to back: body, then cabin, each the same from side to side.
  struct Station {
    double z, y, half;
  };
  constexpr Station kBody[] = {{2.2, 0.55, 0.75},  {2.1, 0.72, 0.84},  {1.0, 0.88, 0.88},
                               {-1.5, 0.92, 0.88}, {-2.1, 0.86, 0.84}, {-2.2, 0.6, 0.78}};
  constexpr Station kCabin[] = {{0.95, 0.88, 0.8}, {0.3, 1.4, 0.66}, {-0.9, 1.43, 0.66}, {-1.7, 0.9, 0.8}};
  const auto shell = [&](const auto& stations, double low, Stuff top, Stuff sides) {
    for (size_t i = 0; i + 1 < std::size(stations); ++i) {
      const auto [z0, y0, h0] = stations[i];
      const auto [z1, y1, h1] = stations[i + 1];
      add_face(mesh, top, {-h0, y0, z0}, {h0, y0, z0}, {h1, y1, z1}, {-h1, y1, z1});
      add_face(mesh, sides, {0.88, low, z0}, {0.88, low, z1}, {h1, y1, z1}, {h0, y0, z0});
      add_face(mesh, sides, {-0.88, low, z1}, {-0.88, low, z0}, {-h0, y0, z0}, {-h1, y1, z1});
    }
  };
  shell(kBody, 0.28, paint, paint);
  shell(kCabin, 0.88, Stuff::glass, Stuff::glass);
  add_face(mesh, paint, {-0.64, 1.44, 0.28}, {0.64, 1.44, 0.28}, {0.64, 1.46, -0.88}, {-0.64, 1.46, -0.88});
  const WallFrame f{{0, 0, 0}};
  add_box(mesh, Stuff::iron, f, {-0.75, 0.75, 0.28, 0.55, 2.15, 2.22}, kAll);
  add_box(mesh, Stuff::iron, f, {-0.75, 0.75, 0.28, 0.6, -2.22, -2.15}, kAll);
  for (const double hand : {-1.0, 1.0}) {
    add_box(mesh, Stuff::paint, f, {hand * 0.6 - 0.16, hand * 0.6 + 0.16, 0.58, 0.7, 2.05, 2.19}, kAll);
    for (const double z : {1.35, -1.35}) {
      // A wheel of eight corners.
      constexpr double kRound[][2] = {{1, 0.414},   {0.414, 1},   {-0.414, 1}, {-1, 0.414},
                                      {-1, -0.414}, {-0.414, -1}, {0.414, -1}, {1, -0.414}};
      const auto rim = [&](int i, double x) {
        return Vec3d{hand * x, 0.32 + 0.3 * kRound[i % 8][1], z + 0.3 * kRound[i % 8][0]};
      };
      for (int i = 0; i < 8; ++i) {
        add_face(mesh, Stuff::rubber, rim(i, 0.7), rim(i + 1, 0.7), rim(i + 1, 0.9), rim(i, 0.9));
        const Corner hub{mesh.vertex({hand * 0.9, 0.32, z}), 0}, a{mesh.vertex(rim(i, 0.9)), 0};
        mesh.triangle(Stuff::steel, hub, a, {mesh.vertex(rim(i + 1, 0.9)), 0});
      }
    }
  }
  return mesh;
}

}  // namespace kd::bench::scenery
