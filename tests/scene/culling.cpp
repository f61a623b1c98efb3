// Culling: what the camera and the lights' rays can meet stays, and what is plainly beside them goes.
#include "scene/culling.h"

#include <algorithm>

#include <doctest/doctest.h>

#include "sys/parallel.h"

using namespace kd;
using namespace kd::scene;

namespace {

const std::vector<Lattice> kLattices{{{0, 0, 0}, {1, 1, 1}, 21}};

Instance cube_at(Vec3d at, double side = 1) {
  Instance i;
  const double step = side / lattice_max(21);
  i.lattice_to_scene = {at, {step, 0, 0}, {0, step, 0}, {0, 0, step}};
  i.scene_to_lattice = invert(i.lattice_to_scene);
  i.box_scene = {at, at + Vec3d{side, side, side}};
  return i;
}

/// From the origin along -z, 90 degrees over 100 x 100 pixels: it sees |x|, |y| < -z.
View view(std::vector<Light> lights = {}) {
  Camera camera;
  camera.vertical_fov_degrees = 90;
  return {camera, {100, 100}, {0, 0, 100, 100}, std::move(lights)};
}

Light light(LightKind kind, Vec3d position, Vec3d direction = {0, -1, 0}) {
  Light l;
  l.kind = kind;
  l.position = position;
  l.direction = normalised(direction);
  return l;
}

std::vector<uint8_t> met(const View& v, const std::vector<Instance>& instances) {
  std::vector<uint8_t> marks(instances.size(), 0);
  mark_met(v, kLattices, instances, marks);
  return marks;
}

using Marks = std::vector<uint8_t>;

}  // namespace

TEST_CASE("culling: the camera's pyramid") {
  const std::vector<Instance> cubes{
      cube_at({-0.5, -0.5, -10}), cube_at({-0.5, -0.5, 5}), cube_at({-100, -100, 1}, 200),  // seen, behind, behind
      cube_at({20, 0, -10}),      cube_at({9, 0, -10}),     cube_at({-1000, 0, -10}),       // beside, at the edge
      cube_at({0, -30, -10}),     cube_at({0, 12, -10}),    cube_at({-0.5, -0.5, -0.5})};   // below, above, around
  CHECK(met(view(), cubes) == Marks{1, 0, 0, 0, 1, 0, 0, 0, 1});
  View crop = view();
  crop.part = {90, 45, 10, 10};  // the right edge: x from 0.8 to 1 of the depth
  CHECK(met(crop, cubes) == Marks{0, 0, 0, 0, 1, 0, 0, 0, 1});
}

TEST_CASE("culling: samples reach a pixel beyond the film") {
  const View v = view();  // a pixel is a fiftieth of the depth
  CHECK(met(v, {cube_at({10.05, 0, -10.5}), cube_at({11, 0, -10.5})}) == Marks{1, 0});
}

TEST_CASE("culling: what may cast a shadow into the picture stays") {
  const Instance seen = cube_at({-0.5, -0.5, -10});
  const std::vector<Instance> cubes{seen, cube_at({-0.5, 20, -10}), cube_at({-0.5, 60, -10}), cube_at({30, 20, -10}),
                                    cube_at({-0.5, 20, 20})};
  CHECK(met(view(), cubes) == Marks{1, 0, 0, 0, 0});
  CHECK(met(view({light(LightKind::directional, {}, {0, -1, 0})}), cubes) == Marks{1, 1, 1, 0, 0});
  CHECK(met(view({light(LightKind::point, {0, 40, -9.5})}), cubes) == Marks{1, 1, 0, 0, 0});
  CHECK(met(view({light(LightKind::point, {0, 40, 49.5})}), cubes) == Marks{1, 0, 0, 0, 1});
  const std::vector<Light> both{light(LightKind::point, {0, 40, -9.5}), light(LightKind::point, {60, 40, -9.5})};
  CHECK(met(view(both), cubes) == Marks{1, 1, 0, 1, 0});
}

TEST_CASE("culling: the same for any number of threads, of which some see nothing") {
  std::vector<Instance> cubes;
  for (int i = 0; i < 40'000; ++i) cubes.push_back(cube_at({-0.5 + 10.0 * (i % 7), 60, 10.0 * (i % 5)}));
  cubes.push_back(cube_at({-0.5, -0.5, -10}));
  const View v = view({light(LightKind::directional, {}, {0, -1, 0})});
  for (const unsigned threads : {1u, 2u, 16u}) {
    const ThreadLimit limit(threads);
    for (int run = 0; run < 20; ++run) {
      const Marks marks = met(v, cubes);
      REQUIRE(std::count(marks.begin(), marks.end(), 1) == 1);
    }
  }
}

TEST_CASE("culling: lights that do not reach what is seen cast no shadow") {
  const std::vector<Instance> cubes{cube_at({-0.5, -0.5, -10}), cube_at({-0.5, 20, -10})};
  Light above = light(LightKind::spot, {0, 40, -9.5}, {0, -1, 0});
  above.outer_degrees = 10;
  CHECK(met(view({above}), cubes) == Marks{1, 1});
  Light black = above, short_of_it = above, away = above, beside = above;
  black.colour = {0, 0, 0};
  short_of_it.reach = 39;
  away.direction = {0, 1, 0};
  beside.direction = normalised(Vec3d{1, -1, 0});
  CHECK(met(view({black, short_of_it, away, beside}), cubes) == Marks{1, 0});
  Light reaching = above;
  reaching.reach = 40;
  CHECK(met(view({reaching}), cubes) == Marks{1, 1});
}

TEST_CASE("culling: of a ground that reaches far, only what is seen is lit") {
  Instance ground = cube_at({-1000, -2, -1000}, 2000);
  ground.box_scene.hi.y = -1.9;
  const Instance near = cube_at({0, -1, -5}), above = cube_at({0, 30, -5}), behind = cube_at({0, 1, 40});
  const Light sun = light(LightKind::directional, {}, {0, -1, 0});
  CHECK(met(view({sun}), {ground, near, above, behind}) == Marks{1, 1, 1, 0});
}

TEST_CASE("culling: coordinates at the end of double's range keep what they are about") {
  const double huge = 1e308;
  Instance i = cube_at({-0.5, -0.5, -10});
  i.box_scene = {{-huge, -huge, -huge}, {huge, huge, huge}};
  View v = view({light(LightKind::point, {huge, huge, huge}), light(LightKind::directional, {}, {1, 1, 1})});
  v.lights.push_back(light(LightKind::spot, {0, huge, 0}));
  const std::vector<Instance> cubes{i, cube_at({0, 5, 5})};
  CHECK(met(v, cubes) == Marks{1, 1});
}
