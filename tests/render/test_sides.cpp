// Which sides of surfaces the camera sees, and that shadows do not ask.
#include <doctest/doctest.h>

#include "worlds.h"

using namespace kd;
using namespace kd::test;

namespace {

scene::Part one_sided(scene::Part p) {
  p.sides = scene::Sides::front;
  return p;
}

const scene::Placement kTurned = [] {
  scene::TransformPlacement t = moved({0.2, 0.1, 0.3}, {0.7, 0.9, 0.6});
  t.rotate_axis = {1, 2, 3};
  t.rotate_degrees = 40;
  return t;
}();

}  // namespace

TEST_CASE("sides: a closed body looks the same from outside, mirrored too") {
  const TempFolder folder;
  const std::string cube = unit_cube().write(folder.file("cube.nkd"));
  const scene::FramePlacement sheared{{{0.1, 0.2, 0}, {0.6, 0.3, 0}, {-0.2, 0.7, 0.1}, {0.1, 0, -0.9}}};
  for (const scene::Placement& placement :
       {kTurned, scene::Placement{moved({1, 0, 0}, {-1, 1, 1})}, scene::Placement{moved({1, 1, 0}, {-0.5, -1, 1})},
        scene::Placement{sheared}}) {
    auto s = scene_of({cube}, {part(0, placement), part(0, moved({0.6, 0.7, -3}))});
    scene::Light light;
    light.position = {2, 3, 4};
    s.lights = {light};
    render::RenderSettings settings = all_aovs();
    settings.aovs.pop_back();  // visits
    const Rendered both(s, settings);
    s.characters[0].parts[0].sides = scene::Sides::front;
    const Rendered front(s, settings);
    CHECK(front.scene.front_only.size() == front.scene.instances.size());
    CHECK(both.scene.front_only.empty());
    CHECK(same_film(both.frame.film, front.frame.film));
    CHECK(both.frame.stats.shadow_rays == front.frame.stats.shadow_rays);
  }
}

TEST_CASE("sides: from inside the camera looks through the backs, and only of parts that ask") {
  const TempFolder folder;
  const std::string cube = unit_cube().write(folder.file("cube.nkd"));
  // Inside the first cube, and before the second.
  auto s = scene_of({cube}, {part(0, moved({-5, -5, -2}, {11, 11, 9})), part(0, moved({0, 0, -6}))});
  const auto instance = [&] {
    const Rendered r(s, all_aovs());
    return r.words(image::Aov::instance)[r.centre()];
  };
  CHECK(instance() == 0);
  s.characters[0].parts[0].sides = scene::Sides::front;
  CHECK(instance() == 1);
  s.characters[0].parts[0].sides = scene::Sides::both;
  CHECK(instance() == 0);
  // One instance alone.
  s.characters[0].parts = {one_sided(s.characters[0].parts[0])};
  CHECK(instance() == render::kNone);
}

TEST_CASE("sides: the outermost part that says decides") {
  const TempFolder folder;
  auto s = scene_of({unit_cube().write(folder.file("cube.nkd"))}, {part(0, moved({0, 0, 0}))});
  s.characters[0].shown = false;
  scene::Part outer;
  outer.character = 0;
  s.characters.push_back({"outer", {outer, outer, outer}});
  const auto marks = [&] {
    const auto loaded = render::load_scene(s, {});
    return std::vector<uint8_t>(loaded->front_only.begin(), loaded->front_only.end());
  };
  using Marks = std::vector<uint8_t>;
  CHECK(marks() == Marks{});
  s.characters[1].parts[1].sides = scene::Sides::front;
  CHECK(marks() == Marks{0, 1, 0});
  s.characters[0].parts[0].sides = scene::Sides::front;
  s.characters[1].parts[1].sides = scene::Sides::both;
  CHECK(marks() == Marks{1, 0, 1});
  // Numbered as they are left by culling.
  std::get<scene::TransformPlacement>(s.characters[1].parts[0].placement).translate = {0, 0, 100};
  CHECK(marks() == Marks{0, 1});
}

TEST_CASE("sides: shadows fall from backs too") {
  const TempFolder folder;
  const std::string cube = unit_cube().write(folder.file("cube.nkd"));
  // The light is within the upper cube, whose lower side it sees from behind; the camera sees the lower cube.
  auto s = scene_of({cube}, {part(0, moved({0, 0, 0})), one_sided(part(0, moved({-1, 1.5, -1}, {3, 3, 3})))});
  s.camera.position = {0.5, 1.2, 5};
  s.camera.target = {0.5, 1, 0.5};
  scene::Light light;
  light.position = {0.5, 3, 0.5};
  s.lights = {light};
  const Rendered shaded(s, {});
  CHECK(shaded.frame.stats.shadow_rays > 0);
  CHECK(shaded.colour(shaded.centre()) == Vec3f{0, 0, 0});
  s.characters[0].parts.pop_back();
  const Rendered lit(s, {});
  float sum = 0;
  for (size_t i = 0; i < 33 * 33; ++i) sum += lit.colour(i).x;
  CHECK(sum > 1);
}
