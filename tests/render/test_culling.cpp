// What no ray can meet is not loaded, and no picture shows it: the same bits with all of the scene and with what
// culling left of it.
#include <doctest/doctest.h>

#include "worlds.h"

using namespace kd;
using namespace kd::test;

namespace {

/// All but the visits: what a ray costs depends on the hierarchy, which has fewer nodes.
render::RenderSettings settings_of_a_picture() {
  render::RenderSettings settings = all_aovs();
  settings.aovs.pop_back();
  return settings;
}

render::Frame picture(const render::LoadedScene& loaded, const render::RenderSettings& settings) {
  return *render::DeviceGroup::open({render::cpu_device()}, false, loaded, settings)->render({});
}

scene::Light random_light(Random& random) {
  scene::Light light;
  light.kind = static_cast<scene::LightKind>(random.integer(0, 2));
  light.position = random.vector(12);
  light.direction = normalised(random.vector(1));
  if (random.chance(0.3)) light.reach = random.real(2, 15);
  light.outer_degrees = random.real(5, 120);
  light.inner_degrees = random.real(0, light.outer_degrees);
  if (random.chance(0.2)) light.colour = {0, 0, 0};
  return light;
}

/// Sheared boxes of both objects everywhere around a camera that sees few of them.
scene::Scene random_scene(Random& random, const std::vector<std::string>& files) {
  std::vector<scene::Part> parts;
  while (parts.size() < 60) {
    const double size = random.chance(0.1) ? 8 : 0.8;
    const Frame f{random.vector(10), random.vector(size), random.vector(size), random.vector(size)};
    if (std::fabs(relative_volume(f)) < 1e-3) continue;
    parts.push_back(part(random.integer(0, 1), scene::BoxPlacement{f}));
  }
  scene::Scene s = scene_of(files, std::move(parts));
  s.film = {random.integer(1, 40), random.integer(1, 30)};
  s.camera.position = random.vector(10);
  s.camera.target = random.vector(10);
  s.camera.vertical_fov_degrees = random.real(5, 130);
  s.ambient = {0.1f, 0.1f, 0.1f};
  for (uint32_t i = random.integer(0, 3); i > 0; --i) s.lights.push_back(random_light(random));
  return s;
}

}  // namespace

TEST_CASE("culling: random pictures are the same without what no ray can meet") {
  const TempFolder folder;
  const std::vector<std::string> files{unit_cube().write(folder.file("cube.nkd")),
                                       Contents(soup_shape(12, 40, Soup::mixed, 1), 12).write(folder.file("soup.nkd"))};
  Random random(5);
  uint32_t left_out = 0, shadow_rays = 0;
  for (int i = 0; i < 150; ++i) {
    const scene::Scene s = random_scene(random, files);
    render::RenderSettings settings = settings_of_a_picture();
    settings.samples = random.chance(0.3) ? 3 : 1;
    if (random.chance(0.3) && s.film.width > 4 && s.film.height > 4) settings.crop = image::Window{2, 3, 2, 1};
    const auto culled = render::load_scene(s, settings),
               all = render::load_scene(s, settings, render::kStill, render::Extent::all);
    REQUIRE(culled);
    REQUIRE(all);
    CHECK(all->skipped.instances == 0);
    CHECK(culled->instances.size() + culled->skipped.instances == all->instances.size());
    left_out += culled->skipped.instances;
    const render::Frame a = picture(*culled, settings), b = picture(*all, settings);
    CHECK(same_film(a.film, b.film));
    CHECK(a.stats.shadow_rays == b.stats.shadow_rays);
    shadow_rays += static_cast<uint32_t>(a.stats.shadow_rays);
  }
  MESSAGE(left_out << " of 9000 instances left out, " << shadow_rays << " shadow rays");
  CHECK(left_out > 3000);
  CHECK(shadow_rays > 5000);
}

TEST_CASE("culling: random films are the same without what no ray can meet") {
  const TempFolder folder;
  const std::vector<std::string> files{unit_cube().write(folder.file("cube.nkd")),
                                       Contents(soup_shape(12, 40, Soup::mixed, 1), 12).write(folder.file("soup.nkd"))};
  const render::RenderSettings settings = settings_of_a_picture();
  Random random(6);
  uint32_t left_out = 0, moved_instances = 0;
  for (int i = 0; i < 25; ++i) {
    scene::Scene s = random_scene(random, files);
    s.camera.keys = {{1, s.camera.position, {}, {}, {}}, {9, random.vector(10), {}, {}, {}}};
    for (scene::Part& p : s.characters[0].parts) {
      if (random.chance(0.5)) continue;
      scene::TransformPlacement way = moved(random.vector(10), {0.5, -1, 1});
      way.keys.resize(2);
      way.keys[0].frame = 2;
      way.keys[0].translate = way.translate;
      way.keys[1].frame = 8;
      way.keys[1].translate = random.vector(10);
      p.placement = way;
    }
    const double frames[] = {7, 1, 4.5, 7, 9};
    auto film = render::load_scene(s, settings, frames);
    REQUIRE(film);
    auto group = render::DeviceGroup::open({render::cpu_device()}, false, *film, settings);
    left_out += film->skipped.instances;
    for (const double frame : frames) {
      const auto moved_parts = render::move_to(*film, s, frame);
      REQUIRE(moved_parts);
      moved_instances += static_cast<uint32_t>(moved_parts->instances.size());
      REQUIRE(group->follow(*moved_parts));
      auto all = render::load_scene(s, settings, render::kStill, render::Extent::all);
      REQUIRE(render::move_to(*all, s, frame));
      CHECK(same_film(group->render({})->film, picture(*all, settings).film));
    }
  }
  MESSAGE(left_out << " of 1500 instances left out, " << moved_instances << " moves of others");
  CHECK(left_out > 200);
  CHECK(moved_instances > 500);
}

TEST_CASE("culling: an object out of sight is not loaded, and one whose shadow is in sight is") {
  const TempFolder folder;
  const std::string cube = unit_cube().write(folder.file("cube.nkd"));
  // Its header is sound, and what it places is not: nobody notices as long as nobody needs it.
  std::string bytes = read_bytes(cube);
  const Contents contents = unit_cube();
  bytes_of(bytes, contents.vertices)[0] ^= 1;
  const std::string spoiled = folder.write("spoiled.nkd", bytes);
  auto s = scene_of({cube, spoiled}, {part(0, moved({0, 0, 0})), part(1, moved({0, 20, 0}))});
  const auto loaded = render::load_scene(s, {});
  REQUIRE(loaded);
  CHECK(loaded->skipped.instances == 1);
  CHECK(loaded->skipped.unmet_objects == 1);
  CHECK(loaded->skipped.objects == 0);
  CHECK(loaded->objects.size() == 1);
  CHECK(loaded->summaries[1]);
  CHECK(loaded->instance_numbers.size() == 1);
  CHECK_FALSE(render::load_scene(s, {}, render::kStill, render::Extent::all));

  scene::Light sun;
  sun.kind = scene::LightKind::directional;
  sun.direction = {0, -1, 0};
  s.lights = {sun};
  CHECK(render::load_scene(s, {}).error().error_class == ErrorClass::object);
  s.objects[1].file = cube;
  const Rendered shaded(s, {});
  CHECK(shaded.scene.skipped.instances == 0);
  CHECK(shaded.scene.instance_numbers.empty());
}

TEST_CASE("culling: instances and objects keep their numbers") {
  const TempFolder folder;
  const std::string cube = unit_cube().write(folder.file("cube.nkd"));
  const auto s = scene_of({cube, cube, cube}, {part(0, moved({0, 0, 20})), part(1, moved({50, 0, 0})),
                                               part(2, moved({0, 0, 0})), part(0, moved({0, 0, 30}))});
  const Rendered r(s, all_aovs());
  CHECK(r.scene.skipped.instances == 3);
  CHECK(r.scene.skipped.unmet_objects == 2);
  CHECK(r.words(image::Aov::instance)[r.centre()] == 2);
  CHECK(r.words(image::Aov::object)[r.centre()] == 2);
  CHECK(r.words(image::Aov::instance)[0] == render::kNone);
}

TEST_CASE("culling: a camera that sees nothing needs nothing") {
  const TempFolder folder;
  auto s = scene_of({unit_cube().write(folder.file("cube.nkd"))}, {part(0, moved({0, 0, 20}))});
  scene::Light light;
  s.lights = {light};
  s.background = {0.25f, 0.5f, 1};
  const Rendered r(s, all_aovs());
  CHECK(r.scene.objects.empty());
  CHECK(r.scene.lights.empty());
  CHECK(r.frame.stats.primary_hits == 0);
  CHECK(r.colour(r.centre()) == s.background);
}

TEST_CASE("culling: a film has what its frames need, and no other frame") {
  const TempFolder folder;
  const std::string cube = unit_cube().write(folder.file("cube.nkd"));
  auto s = scene_of({cube, cube}, {part(0, moved({0, 0, 0})), part(1, moved({0, 0, 100})), part(0, moved({90, 0, 0}))});
  s.camera.keys = {{1, {}, Vec3d{0.5, 0.5, 0}, {}, {}}, {2, {}, Vec3d{0.5, 0.5, 100}, {}, {}}};
  s.camera.position = {0.5, 0.5, 50};
  s.camera.keys[1].target = Vec3d{0.5, 0.5, 101};
  const double both[] = {1, 2};
  auto loaded = render::load_scene(s, {}, both);
  REQUIRE(loaded);
  CHECK(loaded->skipped.instances == 1);
  CHECK(loaded->objects.size() == 2);
  CHECK(loaded->placed->frame() == 1);
  CHECK(render::load_scene(s, {})->objects.size() == 1);
  CHECK(render::move_to(*loaded, s, 2));
  CHECK(render::move_to(*loaded, s, 1.5).error().error_class == ErrorClass::usage);
}
