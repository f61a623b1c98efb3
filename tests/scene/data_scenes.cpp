// The scenes in data/ can be read, and those that move, at each frame of theirs.
#include <filesystem>
#include <string>

#include <doctest/doctest.h>

#include "scene/motion.h"
#include "scene/parse_scene.h"
#include "scene/placed_scene.h"

using namespace kd;
using namespace kd::scene;

TEST_CASE("data: every scene is one, at every frame") {
  namespace fs = std::filesystem;
  int moving = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(KD_SOURCE_DIR "/data")) {
    if (entry.path().extension() != ".json") continue;
    CAPTURE(entry.path().string());
    const auto scene = read_scene(entry.path().string());
    REQUIRE_MESSAGE(scene, (scene ? "" : scene.error().line()));
    const auto range = key_range(*scene);
    if (!range) continue;
    ++moving;
    CHECK(range->first == 1);
    const std::vector<Lattice> lattices(scene->objects.size(), Lattice{{0, 0, 0}, {1, 1, 1}, 21});
    auto placed = PlacedScene::place(*scene, lattices, 1);
    REQUIRE(placed);
    for (int frame = 1; frame <= 240; ++frame) {
      CHECK(camera_at(*scene, frame));
      CHECK(lights_at(*scene, frame));
      const auto moved = placed->move_to(frame);
      REQUIRE(moved);
      CHECK((moved->size() < placed->instances().size() && (frame == 1 || frame > 200 || !moved->empty())));
    }
  }
  CHECK(moving == 2);
}
