// A film's frames by motion: the same bits as each frame alone, whatever came before it.
#include <doctest/doctest.h>

#include "worlds.h"

using namespace kd;
using namespace kd::test;

namespace {

/// A hundred cubes of which every third flies off and turns; a camera and a light that move.
scene::Scene flock(const std::string& cube) {
  std::vector<scene::Part> parts;
  for (int i = 0; i < 100; ++i) {
    scene::TransformPlacement placed = moved({i % 10 - 4.5, i / 10 - 4.5, -i * 0.05}, {0.7, 0.7, 0.7});
    if (i % 3 == 0) {
      scene::TransformKey start, end;
      start.frame = 1;
      start.translate = placed.translate;
      start.rotate = scene::Rotation{{0, 0, 1}, 0};
      end.frame = 20;
      end.translate = placed.translate + Vec3d{i % 7 - 3.0, i % 5 - 2.0, 0.5};
      end.rotate = scene::Rotation{{1, 1, 0}, 170};
      placed.keys = {start, end};
    }
    parts.push_back(part(0, placed));
  }
  scene::Scene s = scene_of({cube}, std::move(parts), 65);
  s.camera = {{0, 0, 20}, {0, 0, 0}, {0, 1, 0}, 35};
  s.camera.keys = {{1, Vec3d{0, 0, 20}, {}, {}, {}}, {20, Vec3d{5, 3, 18}, {}, {}, {}}};
  s.ambient = {0.2f, 0.2f, 0.2f};
  scene::Light light;
  light.position = {3, 8, 10};
  light.keys = {{1, light.position, {}, {}}, {15, Vec3d{-8, 2, 10}, {}, Vec3f{0, 0, 0}}};
  s.lights = {light};
  return s;
}

}  // namespace

TEST_CASE("motion: frames in any order are the frames alone") {
  const TempFolder folder;
  const scene::Scene s = flock(unit_cube().write(folder.file("cube.nkd")));
  render::RenderSettings settings = all_aovs();
  settings.aovs.pop_back();  // visits: what a ray costs depends on the hierarchy, which motion refits
  const double frames[] = {1, 2, 10.5, 20, 3, 400, 15, -5};
  auto loaded = render::load_scene(s, settings, frames);
  REQUIRE(loaded);
  auto group = render::DeviceGroup::open({render::cpu_device()}, false, *loaded, settings);
  REQUIRE(group);
  for (const double& frame : frames) {
    const auto moved_parts = render::move_to(*loaded, s, frame);
    REQUIRE(moved_parts);
    CHECK(moved_parts->instances.size() <= 34);
    REQUIRE(group->follow(*moved_parts));
    const auto frame_by_motion = group->render({});
    REQUIRE(frame_by_motion);
    const auto still = render::load_scene(s, settings, {&frame, 1});
    const auto alone = render::DeviceGroup::open({render::cpu_device()}, false, *still, settings)->render({});
    CHECK(same_film(frame_by_motion->film, alone->film));
    CHECK(frame_by_motion->stats.shadow_rays == alone->stats.shadow_rays);
    if (frame >= 15) CHECK(loaded->skipped.black_lights == 1);
  }
}
