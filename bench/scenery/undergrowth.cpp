#include "scenery/undergrowth.h"

#include <cmath>

#include "scenery/directions.h"

namespace kd::bench::scenery {

namespace {

Stuff shade_of(Stuff first, Random& random) {
  return static_cast<Stuff>(static_cast<uint32_t>(first) + random.below(kShades));
}

/// Three triangles that bend over, with the normals of the ground, which hide how thin a blade is.
void add_blade(ObjMesh& mesh, Vec3d foot, double length, Random& random) {
  const Vec3d lean = any_across(kUp, random);
  const double half_width = random.real(0.006, 0.011);
  const Vec3d across = any_across(kUp, random) * half_width;
  const Vec3d middle = foot + kUp * (0.6 * length) + lean * (0.12 * length);
  const Vec3d tip = foot + kUp * length + lean * (length * random.real(0.25, 0.6));
  const uint32_t n = mesh.normal(kUp + lean * 0.35);
  const Corner left{mesh.vertex(middle - across * 0.8), n}, right{mesh.vertex(middle + across * 0.8), n};
  const Corner foot_left{mesh.vertex(foot - across), n}, foot_right{mesh.vertex(foot + across), n};
  const Corner top{mesh.vertex(tip), n};
  const Stuff stuff = shade_of(Stuff::grass, random);
  mesh.quad(stuff, foot_left, foot_right, right, left);
  mesh.triangle(stuff, left, right, top);
}

void add_flower(ObjMesh& mesh, Vec3d head, Random& random) {
  const Vec3d axis = normalised(kUp + any_direction(random) * 0.4);
  for (int petal = 0; petal < 5; ++petal) {
    const Vec3d out = any_across(axis, random) * 0.035;
    mesh.leaf(Stuff::petals, head, out + axis * 0.01, cross(axis, out) * 0.4, axis);
  }
}

}  // namespace

ObjMesh grow_turf(double side, int blades, int per_flower, uint64_t seed) {
  ObjMesh mesh;
  Random random(seed, 0);
  for (int i = 0; i < blades; ++i) {
    const double x = random.real(-0.53, 0.53) * side, z = random.real(-0.53, 0.53) * side;
    // Grass grows in clumps: tall where the noise is high.
    const double length = (0.24 + 0.14 * noise({1.7 * x, 0, 1.7 * z}, seed)) * random.real(0.6, 1.3);
    add_blade(mesh, {x, -0.1, z}, length + 0.1, random);
    if (per_flower > 0 && i % per_flower == 0) add_flower(mesh, {x, length + 0.05, z}, random);
  }
  return mesh;
}

ObjMesh grow_fern(uint64_t seed) {
  ObjMesh mesh;
  Random random(seed, 0);
  constexpr int kFronds = 11, kLeaflets = 18;
  for (int frond = 0; frond < kFronds; ++frond) {
    const Vec3d out = any_across(kUp, random), side = cross(out, kUp);
    const double length = random.real(0.55, 0.95), rise = random.real(0.5, 0.9);
    const auto at = [&](double s) { return out * (length * s) + kUp * (length * rise * s * (1.6 - 1.3 * s)); };
    for (int leaflet = 0; leaflet < kLeaflets; ++leaflet) {
      const double s = (leaflet + 1.0) / (kLeaflets + 1);
      const double reach = 0.28 * length * (1.1 - s) * std::fmin(1, 5 * s);
      for (const double hand : {-1.0, 1.0}) {
        const Vec3d along = side * (hand * reach) + out * (0.35 * reach) - kUp * (0.2 * reach);
        mesh.leaf(shade_of(Stuff::shrub, random), at(s), along, out * 0.022, kUp + out * 0.3 + side * (0.3 * hand));
      }
    }
  }
  return mesh;
}

ObjMesh make_rock(int cells, uint64_t seed) {
  ObjMesh mesh;
  // A cube of so many cells an edge is blown up to a ball, and that is dented.
  const auto surface = [&](Vec3d cube) {
    const Vec3d d = normalised(cube);
    const double dent = 0.25 * noise(d * 1.3, seed) + 0.12 * noise(d * 3.1, seed + 1) + 0.05 * noise(d * 8.0, seed + 2);
    return Vec3d{0.7, 0.5, 0.6} * (d * (1 + dent));
  };
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const double side = face % 2 == 0 ? -1 : 1;
    const auto corner = [&](int i, int j) {
      Vec3d p;
      p.set(axis, side);
      p.set((axis + 1) % 3, side * (2.0 * i / cells - 1));
      p.set((axis + 2) % 3, 2.0 * j / cells - 1);
      return Corner{mesh.vertex(surface(p)), 0};
    };
    for (int i = 0; i < cells; ++i) {
      for (int j = 0; j < cells; ++j) {
        const Corner a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1), d = corner(i, j + 1);
        mesh.quad(Stuff::stone, a, b, c, d);
      }
    }
  }
  return mesh;
}

}  // namespace kd::bench::scenery
