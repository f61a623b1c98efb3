#include "scenery/city.h"

#include <cmath>
#include <span>

#include <fmt/format.h>

#include "scenery/building.h"
#include "scenery/directions.h"
#include "scenery/street.h"
#include "scenery/tree.h"

namespace kd::bench::scenery {

namespace {

/// Objects, in the order in which they are made: buildings first, the lowest ones first.
enum CityKind : uint32_t {
  narrow_house,
  brick_house,
  plaster_house,
  stone_house,
  corner_house,
  flats,
  tall_flats,
  low_office,
  office,
  slab,
  stepped,
  tower,
  needle,
  plane_tree,
  lamp,
  dark_car,
  red_car,
  pale_car,
  lawn,
  street,
  plain,
};

struct Plan {
  const char* name;
  std::vector<Tier> tiers;
  Style style;
};

const std::vector<Plan>& plans() {
  static const std::vector<Plan> kPlans{
      {"narrow_house", {{9, 13, 4}}, {.roof = Roof::gabled, .foot = Stuff::brick}},
      {"brick_house",
       {{14, 13, 4}},
       {.storey = 3.4, .window_width = 0.5, .balcony_every = 4, .roof = Roof::gabled, .wall = Stuff::brick}},
      {"plaster_house", {{18, 13, 5}}, {.balcony_every = 3, .roof = Roof::gabled}},
      {"stone_house",
       {{18, 13, 4}},
       {.storey = 3.6, .window_height = 0.66, .roof = Roof::gabled, .wall = Stuff::limestone}},
      {"corner_house", {{14, 13, 6}}, {.balcony_every = 2, .wall = Stuff::brick}},
      {"flats",
       {{24, 15, 8}},
       {.storey = 2.9,
        .bay = 3,
        .window_width = 0.7,
        .balcony_every = 2,
        .foot = Stuff::concrete,
        .trim = Stuff::concrete}},
      {"tall_flats",
       {{22, 22, 14}},
       {.storey = 2.9,
        .bay = 2.8,
        .window_width = 0.65,
        .balcony_every = 3,
        .wall = Stuff::concrete,
        .foot = Stuff::concrete,
        .trim = Stuff::concrete}},
      {"low_office",
       {{30, 18, 6}},
       {.storey = 3.6, .bay = 3, .window_width = 0.75, .panes_across = 3, .wall = Stuff::limestone}},
      {"office",
       {{30, 20, 12}},
       {.storey = 3.5,
        .bay = 1.8,
        .window_width = 0.8,
        .panes_across = 1,
        .wall = Stuff::concrete,
        .trim = Stuff::steel}},
      {"slab",
       {{36, 18, 18}},
       {.storey = 3.4,
        .bay = 1.6,
        .window_width = 0.86,
        .window_height = 0.72,
        .panes_across = 1,
        .wall = Stuff::concrete,
        .trim = Stuff::limestone}},
      {"stepped",
       {{30, 30, 12}, {24, 24, 8}, {16, 16, 6}, {8, 8, 3}},
       {.storey = 3.6, .bay = 2, .window_width = 0.5, .window_height = 0.62, .wall = Stuff::limestone}},
      {"tower",
       {{28, 28, 30}, {22, 22, 6}},
       {.storey = 3.6,
        .bay = 1.7,
        .window_width = 0.9,
        .window_height = 0.78,
        .panes_across = 1,
        .wall = Stuff::steel,
        .trim = Stuff::steel}},
      {"needle",
       {{26, 26, 22}, {21, 21, 16}, {15, 15, 10}, {7, 7, 6}},
       {.storey = 3.7, .bay = 1.9, .window_width = 0.6, .window_height = 0.7, .panes_across = 1, .wall = Stuff::brick}},
  };
  return kPlans;
}

std::vector<NamedMesh> make_meshes(uint64_t seed) {
  std::vector<NamedMesh> meshes;
  const auto add = [&](const char* name, ObjMesh mesh) { meshes.push_back({name, std::move(mesh)}); };
  for (const Plan& plan : plans()) add(plan.name, raise_building(plan.tiers, plan.style, seed + meshes.size()));
  add("plane_tree", grow_tree({.height = 8.5,
                               .radius = 0.17,
                               .branches = 9,
                               .reach = 0.3,
                               .forks = 5,
                               .twigs = 4,
                               .leaves = 8,
                               .leaf_length = 0.36,
                               .leaf_width = 0.26},
                              seed + 30));
  add("lamp", make_lamp());
  add("dark_car", make_car(Stuff::iron));
  add("red_car", make_car(Stuff::awning));
  add("pale_car", make_car(Stuff::steel));
  add("lawn", lay_lawn(seed + 31));
  add("street", lay_street());
  return meshes;
}

/// A piece of land without end, for what is behind the last block.
ObjMesh make_plain(double half) {
  ObjMesh mesh;
  const auto corner = [&](double x, double z) { return Corner{mesh.vertex({x, -0.3, z}), 0}; };
  const Corner a = corner(-half, half), b = corner(half, half), c = corner(half, -half);
  mesh.quad(Stuff::moss, a, b, c, corner(-half, -half));
  return mesh;
}

enum BlockId { houses, mansions, offices, towers, park };
constexpr int kBlockIds = park + 1;
constexpr int kVariants[kBlockIds] = {6, 4, 4, 5, 2};
constexpr const char* kBlockNames[kBlockIds] = {"houses", "mansions", "offices", "towers", "park"};

/// One block in the making.
class Block {
 public:
  Block(BlockId id, int variant, uint64_t seed) : random_(seed, 0) {
    character.name = fmt::format("{}_{}", kBlockNames[id], variant);
    character.shown = false;
    place(street, 0, 0, 0, 0);
    build(id);
    furnish();
  }

  scene::Character character;

 private:
  static constexpr double kYard = kBlock / 2 - kRoad / 2 - kPavement;  // from the middle to where houses begin

  void place(CityKind kind, double x, double z, uint32_t degrees, double y = kKerb) {
    scene::Part part;
    part.object = kind;
    scene::TransformPlacement at{.translate = {centimetres(x), y, centimetres(z)}};
    if (degrees != 0) {
      at.rotate_axis = kUp;
      at.rotate_degrees = degrees;
    }
    part.placement = at;
    character.parts.push_back(std::move(part));
  }

  /// With its front towards side 0 (+z), 1 (+x), 2 or 3 of the block, `along` to the right as seen from there; `turned`
  /// by so many degrees more.
  void place_at_side(CityKind kind, uint32_t side, double along, double out, uint32_t turned = 0, double y = kKerb) {
    const double x[] = {along, out, -along, -out}, z[] = {out, -along, -out, along};
    place(kind, x[side], z[side], (90 * side + turned) % 360, y);
  }

  /// Buildings side by side along all four sides, their fronts to the street. The rows of sides 0 and 2 have the
  /// corners.
  void add_rows(std::span<const CityKind> kinds) {
    for (uint32_t side = 0; side < 4; ++side) {
      const double room = side % 2 == 0 ? 2 * kYard : 2 * (kYard - 15.5);
      std::vector<CityKind> row;
      double used = 0;
      for (int attempt = 0; attempt < 24; ++attempt) {
        const CityKind kind = kinds[random_.below(static_cast<uint32_t>(kinds.size()))];
        const double width = plans()[kind].tiers[0].width;
        if (used + width > room) continue;
        row.push_back(kind);
        used += width;
      }
      const double gap = (room - used) / static_cast<double>(row.size());
      double along = -room / 2 + gap / 2;
      for (const CityKind kind : row) {
        const Tier& foot = plans()[kind].tiers[0];
        place_at_side(kind, side, along + foot.width / 2, kYard - foot.depth / 2 - 0.3);
        along += foot.width + gap;
      }
    }
  }

  void add_trees(int count, double within) {
    for (int i = 0; i < count; ++i) {
      const double x = random_.real(-within, within), z = random_.real(-within, within);
      place(plane_tree, x, z, random_.below(360));
    }
  }

  void build(BlockId id) {
    constexpr CityKind kHouses[] = {narrow_house, brick_house, plaster_house, stone_house, corner_house};
    constexpr CityKind kMansions[] = {plaster_house, stone_house, corner_house, flats};
    constexpr CityKind kOffices[] = {low_office, office, flats};
    constexpr CityKind kTall[] = {tower, needle, stepped, slab, office, tall_flats};
    switch (id) {
      case houses:
        add_rows(kHouses);
        return add_trees(4, kYard - 18);
      case mansions:
        add_rows(kMansions);
        return add_trees(3, kYard - 20);
      case offices:
        for (uint32_t side = 0; side < 4; side += 2) {
          const CityKind left = kOffices[random_.below(3)],
                         right = random_.chance(0.3) ? slab : kOffices[random_.below(3)];
          place_at_side(left, side, -kYard / 2, kYard - 11);
          place_at_side(right, side, kYard / 2 - 2, kYard - 11);
        }
        place(random_.chance(0.5) ? tall_flats : stepped, 0, 0, 0);
        return;
      case towers:
        for (uint32_t lot = 0; lot < 4; ++lot) {
          if (random_.chance(0.15)) {
            place_at_side(plane_tree, lot, -kYard / 2, kYard / 2);
          } else {
            place_at_side(kTall[random_.below(6)], lot, -kYard / 2, kYard / 2);
          }
        }
        return;
      case park:
        place(lawn, 0, 0, 0, 0);
        return add_trees(36, kYard - 3);
    }
  }

  /// Lamps and trees on the pavement, cars along the kerb.
  void furnish() {
    constexpr CityKind kCars[] = {dark_car, red_car, pale_car};
    const double pavement = kYard + kPavement - 0.7, kerb = kYard + kPavement;
    for (uint32_t side = 0; side < 4; ++side) {
      for (const double along : {-30.0, -10.0, 10.0, 30.0}) place_at_side(lamp, side, along, pavement);
      for (const double along : {-20.0, 0.0, 20.0}) {
        if (random_.chance(0.6)) place_at_side(plane_tree, side, along, pavement);
      }
      for (double along = -27; along <= 27; along += 6) {
        if (!random_.chance(0.4)) continue;
        const CityKind car = kCars[random_.below(3)];
        place_at_side(car, side, along, kerb + 1.3, random_.chance(0.5) ? 90 : 270, 0);
      }
    }
  }

  Random random_;
};

BlockId block_for(double x, double z, Random& random) {
  if (random.chance(0.06)) return park;
  const double away = std::sqrt(x * x + z * z) * (1 + 0.5 * noise({x / 400, 0, z / 400}, 5)) + random.real(-60, 60);
  if (away < 380) return towers;
  if (away < 620) return offices;
  return away < 1100 || random.chance(0.15) ? mansions : houses;
}

/// One of a block's eight symmetries, taller or lower.
Frame turned(double x, double z, Random& random) {
  const double sx = random.sign(), sz = random.sign(), tall = centimetres(random.real(0.85, 1.2));
  if (random.chance(0.5)) return {{x, 0, z}, {sx, 0, 0}, {0, tall, 0}, {0, 0, sz}};
  return {{x, 0, z}, {0, 0, sx}, {0, tall, 0}, {sz, 0, 0}};
}

void set_view(scene::Scene& scene) {
  scene.film = {1920, 1080};
  scene.camera.position = {-690, 150, 1010};
  scene.camera.target = {-60, 42, 0};
  scene.camera.vertical_fov_degrees = 36;
  scene.background = {0.60f, 0.74f, 0.90f};
  scene.ambient = {0.30f, 0.35f, 0.44f};
  scene::Light sun;
  sun.kind = scene::LightKind::directional;
  sun.direction = normalised(Vec3d{0.62, -0.60, -0.50});
  sun.colour = {1.6f, 1.42f, 1.15f};
  scene.lights.push_back(sun);
}

}  // namespace

Scenery lay_out_city(uint64_t triangles, uint64_t seed, const std::string& folder) {
  Scenery city;
  city.meshes = make_meshes(seed);
  scene::Scene& scene = city.scene;
  uint32_t first[kBlockIds];
  for (int id = 0; id < kBlockIds; ++id) {
    first[id] = static_cast<uint32_t>(scene.characters.size());
    for (int variant = 0; variant < kVariants[id]; ++variant) {
      Block block(static_cast<BlockId>(id), variant, seed + 100 + scene.characters.size());
      scene.characters.push_back(std::move(block.character));
    }
  }

  scene::Character town;
  int side = 0;
  do {
    // Sides are even, so that larger cities have the blocks of smaller ones.
    side += 2;
    town.parts.clear();
    city.instances = city.triangles = 0;
    for (int row = 0; row < side; ++row) {
      for (int column = 0; column < side; ++column) {
        const int x = 2 * column - side + 1, z = 2 * row - side + 1;
        Random random(seed, static_cast<uint64_t>(x + (1 << 20)) << 32 | static_cast<uint64_t>(z + (1 << 20)));
        const BlockId id = block_for(x * kBlock / 2, z * kBlock / 2, random);
        scene::Part part;
        part.character = first[id] + random.below(kVariants[id]);
        part.placement = scene::FramePlacement{turned(x * kBlock / 2, z * kBlock / 2, random)};
        for (const scene::Part& placed : scene.characters[*part.character].parts) {
          ++city.instances;
          city.triangles += city.meshes[placed.object].mesh.triangle_count();
        }
        town.parts.push_back(std::move(part));
      }
    }
  } while (city.triangles < triangles);

  city.meshes.push_back({"plain", make_plain(std::fmax(20'000, side * kBlock))});
  scene::Character land;
  land.name = "land";
  scene::Part ground;
  ground.object = plain;
  land.parts.push_back(std::move(ground));
  ++city.instances;
  city.triangles += city.meshes[plain].mesh.triangle_count();
  town.name = "town";
  scene.characters.push_back(std::move(town));
  scene.characters.push_back(std::move(land));
  for (const NamedMesh& mesh : city.meshes)
    scene.objects.push_back({mesh.name, fmt::format("{}/compiled/{}.nkd", folder, mesh.name)});
  set_view(scene);
  return city;
}

}  // namespace kd::bench::scenery
