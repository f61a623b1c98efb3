// Loading: what a scene does not need is not opened, read or placed; what cannot be placed says where.
#include <doctest/doctest.h>

#include "render/stages/colour.h"
#include "worlds.h"

using namespace kd;
using namespace kd::test;
using render::load_scene;

namespace {

scene::Light light(Vec3f colour) {
  scene::Light l;
  l.position = {0.5, 0.5, 5};
  l.colour = colour;
  return l;
}

}  // namespace

TEST_CASE("load: an object that no part places is not opened") {
  const TempFolder folder;
  const std::string cube = unit_cube().write(folder.file("cube.nkd"));
  auto s = scene_of({folder.file("none.nkd"), cube, folder.write("bad.nkd", "no object")}, {part(1, moved({}))});
  const auto loaded = load_scene(s, {});
  REQUIRE(loaded);
  CHECK(loaded->skipped.objects == 2);
  REQUIRE(loaded->objects.size() == 1);
  CHECK(loaded->object_numbers[0] == 1);
  CHECK(loaded->object_slots == std::vector<uint32_t>{render::kNone, 0, render::kNone});
  CHECK(loaded->instances.size() == 1);

  s.characters[0].parts.push_back(part(0, moved({})));
  const auto missing = load_scene(s, {});
  REQUIRE_FALSE(missing);
  CHECK(missing.error().error_class == ErrorClass::missing);
  s.characters[0].parts.back().object = 2;
  CHECK(load_scene(s, {}).error().error_class == ErrorClass::object);
}

TEST_CASE("load: geometry is found sound, or not, while a device is opened") {
  const TempFolder folder;
  const std::string cube = unit_cube().write(folder.file("cube.nkd"));
  std::vector<std::string> files(20, cube);
  std::vector<scene::Part> parts;
  for (uint32_t i = 0; i < files.size(); ++i) parts.push_back(part(i, moved({2.0 * i, 0, 0})));
  const auto s = scene_of(files, parts);
  const auto begun = [](const scene::Scene& placed) {
    return load_scene(placed, {}, render::kStill, render::Extent::all, render::Checking::going_on);
  };
  const auto opened = [](const render::LoadedScene& loaded) {
    return render::DeviceGroup::open({render::cpu_device()}, false, loaded, {});
  };
  const auto loaded = begun(s);
  REQUIRE(loaded);
  CHECK(bool(opened(*loaded)));
  CHECK(loaded->checks.all_sound());

  std::string bytes = read_bytes(cube);
  const Contents contents = unit_cube();
  bytes_of(bytes, contents.vertices)[0] ^= 1;
  auto broken = s;
  for (const size_t i : {7, 12}) broken.objects[i].file = folder.write("broken" + std::to_string(i) + ".nkd", bytes);
  const auto unsound = begun(broken);
  REQUIRE(unsound);
  const auto refused = opened(*unsound);
  REQUIRE_FALSE(refused);
  const auto at_once = load_scene(broken, {}, render::kStill, render::Extent::all);
  REQUIRE_FALSE(at_once);
  CHECK(refused.error().error_class == ErrorClass::object);
  CHECK(refused.error().line() == at_once.error().line());
  CHECK(refused.error().where == broken.objects[7].file);
  CHECK(bool(begun(broken)));  // and never asked about
}

TEST_CASE("load: black lights are left out") {
  const TempFolder folder;
  auto s = scene_of({unit_cube().write(folder.file("cube.nkd"))}, {part(0, moved({}))});
  s.lights = {light({0, 0, 0}), light({0, 0.5f, 0}), light({0, 0, 0})};
  const Rendered r(s, {});
  CHECK(r.scene.lights.size() == 1);
  CHECK(r.scene.skipped.black_lights == 2);
  const std::string_view lighting = render::Lighting<render::OnlyInstance<>>::kName;
  for (const render::StageTime& stage : r.frame.stats.stages) {
    if (stage.stage == lighting) CHECK(stage.launches == 1);
  }
  s.lights = {light({0, 0, 0})};
  const Rendered dark(s, {});
  CHECK(dark.frame.stats.shadow_rays == 0);
  for (const render::StageTime& stage : dark.frame.stats.stages) CHECK(stage.stage != lighting);
}

TEST_CASE("load: sections are read when some stage reads them, and only then") {
  const TempFolder folder;
  // Every attribute section is corrupt: reading one is an error, which is how the test sees it.
  const Contents c(box_shape({0, 0, 0}, {1023, 1023, 1023}), 10);
  std::string bytes = read_bytes(c.write(folder.file("good.nkd")));
  const auto spoiled = [&](auto section) {
    std::string bad = bytes;
    bytes_of(bad, section)[0] ^= 1;
    return folder.write("bad.nkd", bad);
  };
  const auto loads = [&](const std::string& file, bool lit, Vec3f ambient, std::vector<image::Aov> aovs,
                         bool own_material = true) {
    auto s = scene_of({file}, {part(0, moved({}))});
    if (lit) s.lights = {light({1, 1, 1})};
    s.ambient = ambient;
    if (!own_material) s.characters[0].parts[0].material = Material{};
    render::RenderSettings settings;
    settings.aovs = std::move(aovs);
    return bool(load_scene(s, settings));
  };
  using image::Aov;
  const std::string normals = spoiled(c.normals);
  CHECK(loads(normals, false, {1, 1, 1}, {Aov::depth, Aov::primitive, Aov::position}));
  CHECK_FALSE(loads(normals, true, {0, 0, 0}, {}));
  CHECK_FALSE(loads(normals, false, {0, 0, 0}, {Aov::normal}));
  const std::string materials = spoiled(c.materials);
  CHECK(loads(materials, false, {0, 0, 0}, {Aov::depth, Aov::normal, Aov::primitive}));
  CHECK(loads(materials, true, {1, 1, 1}, {}, false));
  CHECK_FALSE(loads(materials, true, {0, 0, 0}, {}));
  CHECK_FALSE(loads(materials, false, {0, 0.1f, 0}, {}));
  const std::string sources = spoiled(c.source_primitives);
  CHECK(loads(sources, true, {1, 1, 1}, {Aov::depth, Aov::normal}));
  CHECK_FALSE(loads(sources, false, {0, 0, 0}, {Aov::primitive}));

  auto s = scene_of({folder.file("good.nkd")}, {part(0, moved({}))});
  const auto bare = load_scene(s, {});
  REQUIRE(bare);
  CHECK(bare->skipped.sections == 5);
  CHECK(bare->skipped.aov_buffers == image::kAovRows.size());
  CHECK(bare->objects[0].attributes.normals.empty());
  s.lights = {light({1, 1, 1})};
  const auto full = load_scene(s, all_aovs());
  REQUIRE(full);
  CHECK(full->skipped.sections == 0);
  CHECK(full->skipped.aov_buffers == 0);
  CHECK(full->objects[0].attributes.normals.size() == 3);
}

TEST_CASE("load: a placement that cannot be says on which line") {
  const TempFolder folder;
  const std::string cube = unit_cube().write(folder.file("cube.nkd"));
  const double huge = 1e308;
  for (const scene::Placement& placement :
       {scene::Placement{scene::BoxPlacement{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 1}}}},
        scene::Placement{scene::BoxPlacement{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1e-12}}}},
        scene::Placement{scene::BoxPlacement{{{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}}}},
        scene::Placement{scene::FramePlacement{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 1}}}},
        scene::Placement{moved({huge, 0, 0}, {huge, 1, 1})}, scene::Placement{moved({HUGE_VAL, 0, 0})}}) {
    auto s = scene_of({cube}, {part(0, moved({})), part(0, placement)});
    s.characters[0].parts[1].line = 42;
    s.characters[0].parts[1].name = "bent";
    const auto loaded = load_scene(s, {});
    REQUIRE_FALSE(loaded);
    CHECK(loaded.error().error_class == ErrorClass::scene);
    CHECK(loaded.error().where == "test.json:42");
    CHECK(loaded.error().what.find("bent") != std::string::npos);
  }
}

TEST_CASE("load: a scene of nothing") {
  auto s = scene_of({}, {});
  s.background = {0.25f, 0.5f, 1};
  const Rendered r(s, all_aovs());
  CHECK(r.frame.stats.primary_hits == 0);
  CHECK(r.colour(0) == s.background);
  CHECK(r.number(image::Aov::depth, 5) == std::numeric_limits<float>::infinity());
  CHECK(r.words(image::Aov::instance)[5] == 0xffffffffu);
}
