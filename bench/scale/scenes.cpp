#include "scale/scenes.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "kdbuild/build_source.h"
#include "scenery/scenery.h"
#include "scenery/undergrowth.h"

namespace kd::bench::scale {

namespace {

namespace fs = std::filesystem;

constexpr int kCells = 10;  // 1200 triangles a stone
constexpr double kWidth = 16, kHeight = 9, kDistance = 120;
constexpr double kStoneScale = 0.62;  // of a cell's side: a stone then nearly touches its neighbours

/// `count` cells that fill a wall.
struct Grid {
  uint64_t columns, rows;
  double cell;

  explicit Grid(uint64_t count)
      : columns(std::max<uint64_t>(
            1, static_cast<uint64_t>(std::lround(std::sqrt(static_cast<double>(count) * kWidth / kHeight))))),
        rows((count + columns - 1) / columns),
        cell(std::min(kWidth / static_cast<double>(columns), kHeight / static_cast<double>(rows))) {}
  double x(uint64_t column) const {
    return (static_cast<double>(column) + 0.5 - 0.5 * static_cast<double>(columns)) * cell;
  }
  double y(uint64_t row) const { return (static_cast<double>(row) + 0.5 - 0.5 * static_cast<double>(rows)) * cell; }
};

scene::Part stone(uint32_t object, Vec3d at, double scale) {
  scene::Part part;
  part.object = object;
  part.placement = scene::TransformPlacement{.translate = at, .scale = {scale, scale, scale}};
  return part;
}

}  // namespace

Result<Quarry> Quarry::open(const std::string& folder) {
  std::vector<scenery::NamedMesh> stones;
  for (uint32_t i = 0; i < kStones; ++i)
    stones.push_back({fmt::format("stone{}", i), scenery::make_rock(kCells, 3 * i)});
  if (auto written = scenery::write_meshes(folder, "stones", stones); !written) return written.error();
  for (const scenery::NamedMesh& stone : stones) {
    const std::string path = folder + "/" + stone.name;
    if (auto built = tools::build_object(path + ".obj", path + ".nkd", {}); !built) return built.error();
  }
  return Quarry(folder);
}

Result<std::vector<scene::SceneObject>> Quarry::objects(uint32_t count) const {
  std::vector<scene::SceneObject> objects;
  for (uint32_t i = 0; i < count; ++i) {
    const std::string name = fmt::format("stone{}", i), file = scene::library_file(folder_, name);
    std::error_code failure;
    if (!fs::exists(file, failure)) {
      // Copies, not links: each has pages of its own to be read.
      fs::copy_file(scene::library_file(folder_, fmt::format("stone{}", i % kStones)), file, failure);
      if (failure) return Error{ErrorClass::output, file, "cannot copy an object: " + failure.message()};
    }
    objects.push_back({name, file});
  }
  return objects;
}

scene::Scene empty_scene(std::vector<scene::SceneObject> objects, scene::FilmSize film) {
  scene::Scene scene;
  scene.film = film;
  scene.camera.position = {0, 0, kDistance};
  scene.camera.target = {0, 0, 0};
  scene.camera.vertical_fov_degrees = 2 * std::atan(0.5 * kHeight / kDistance) * 180 / std::numbers::pi;
  scene.background = {0.5f, 0.6f, 0.8f};
  scene.ambient = {0.2f, 0.2f, 0.25f};
  scene.objects = std::move(objects);
  set_lights(scene, 1, Lighting::lit);
  return scene;
}

void add_wall(scene::Scene& scene, uint64_t count, Place place, uint32_t first, uint32_t end) {
  if (count == 0) return;
  const Grid grid(count);
  const uint64_t objects = end - first;
  const auto row_of = [&](uint64_t stones, uint64_t start) {
    scene::Character row;
    row.shown = false;
    for (uint64_t column = 0; column < stones; ++column) {
      const auto object = first + static_cast<uint32_t>((start + column) % objects);
      row.parts.push_back(stone(object, {grid.x(column), 0, 0}, kStoneScale * grid.cell));
    }
    return row;
  };
  std::map<std::pair<uint64_t, uint64_t>, uint32_t>
      rows;  // by stones and the first one's object: equal ones are shared
  scene::Character wall;
  const double z = place == Place::in_view ? 0 : 3 * kDistance;
  for (uint64_t row = 0; row < grid.rows; ++row) {
    const uint64_t before = row * grid.columns, stones = std::min(grid.columns, count - before);
    const auto [at, is_new] =
        rows.try_emplace({stones, before % objects}, static_cast<uint32_t>(scene.characters.size()));
    if (is_new) {
      scene.characters.push_back(row_of(stones, before % objects));
      scene.characters.back().name = fmt::format("row {}", at->second);
    }
    scene::Part part;
    part.character = at->second;
    part.placement = scene::TransformPlacement{.translate = {0, grid.y(row), z}};
    wall.parts.push_back(std::move(part));
  }
  scene.characters.push_back(std::move(wall));
}

void add_drifting(scene::Scene& scene, uint32_t count) {
  if (count == 0) return;
  const Grid grid(count);
  constexpr double kFrames = 1000;
  scene::Character drifting;
  for (uint32_t i = 0; i < count; ++i) {
    const Vec3d at{grid.x(i % grid.columns), grid.y(i / grid.columns), 1};
    scene::Part part = stone(i % kStones, at, kStoneScale * grid.cell);
    const Vec3d way{i % 2 == 0 ? 0.1 : -0.1, i % 3 == 0 ? 0.05 : -0.05, 0};
    auto& placement = std::get<scene::TransformPlacement>(part.placement);
    placement.keys.resize(2);
    placement.keys[0].frame = 1;
    placement.keys[0].translate = at;
    placement.keys[1].frame = 1 + kFrames;
    placement.keys[1].translate = at + way * (kFrames * grid.cell);
    drifting.parts.push_back(std::move(part));
  }
  scene.characters.push_back(std::move(drifting));
}

void set_lights(scene::Scene& scene, uint32_t count, Lighting lighting) {
  scene.lights.clear();
  for (uint32_t i = 0; i < count; ++i) {
    scene::Light light;
    light.kind = scene::LightKind::directional;
    const double lean = static_cast<double>(i) / count;
    // Those behind shine straight at the camera: no surface that it sees faces them.
    light.direction = lighting == Lighting::behind ? Vec3d{0, 0, 1} : normalised(Vec3d{lean - 0.5, -0.5, -2});
    const auto share = static_cast<float>(lighting == Lighting::black ? 0 : 1.0 / count);
    light.colour = {share, share, share};
    scene.lights.push_back(light);
  }
}

}  // namespace kd::bench::scale
