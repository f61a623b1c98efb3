// Lights that do not shine evenly: cones, falloff and reach, against their formulas; and rays that are not cast.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "render/stages/surface.h"
#include "worlds.h"

using namespace kd;
using namespace kd::test;

namespace {

/// A white floor of 10 x 10 at y = 0 from above, lit by one light.
struct Floor {
  TempFolder folder;
  scene::Scene scene;
  Floor() {
    scene = scene_of({unit_cube().write(folder.file("cube.nkd"))}, {part(0, moved({-5, -1, -5}, {10, 1, 10}))}, 65);
    scene.camera = {{0, 10, 0}, {0, 0, 0}, {0, 0, -1}, 45};
    Material white;
    white.diffuse = {1, 1, 1};
    scene.characters[0].parts[0].material = white;
    scene::Light light;
    light.position = {0.5, 2, 0.25};
    light.direction = {0, -1, 0};
    light.colour = {3, 3, 3};
    scene.lights = {light};
  }
};

double smooth(double s) { return s <= 0 ? 0 : s >= 1 ? 1 : s * s * (3 - 2 * s); }

/// What arrives at a point of the floor and is reflected, by the scene format's formulas.
double expected(const scene::Light& light, Vec3d p) {
  const Vec3d way = light.position - p;
  const double d = length(way), cosine = way.y / d;
  double share = light.falloff == scene::Falloff::inverse_square ? 1 / (d * d) : 1;
  const double far = d / light.reach;
  share *= far < 1 ? std::pow(1 - std::pow(far, 4), 2) : 0;
  if (light.kind == scene::LightKind::spot) {
    const auto cos_of = [](double degrees) { return std::cos(degrees * std::numbers::pi / 180); };
    const double inner = cos_of(light.inner_degrees), outer = cos_of(light.outer_degrees);
    share *= smooth((-dot(light.direction, way) / d - outer) / (inner - outer));
  }
  return 3 * cosine * share;
}

void check_floor(const Floor& floor) {
  const Rendered r(floor.scene, all_aovs());
  double worst = 0;
  int lit = 0;
  for (size_t pixel = 0; pixel < 65 * 65; ++pixel) {
    if (r.words(image::Aov::instance)[pixel] != 0) continue;
    const Vec3d p{r.number(image::Aov::position, 3 * pixel), r.number(image::Aov::position, 3 * pixel + 1),
                  r.number(image::Aov::position, 3 * pixel + 2)};
    const double value = expected(floor.scene.lights[0], p);
    lit += value > 0;
    worst = std::max(worst, std::fabs(value - static_cast<double>(r.colour(pixel).x)));
  }
  CHECK(lit > 100);
  CHECK(worst < 1e-4);
  CHECK(r.frame.stats.shadow_rays == static_cast<uint64_t>(lit));
}

}  // namespace

TEST_CASE("lights: falloff, reach and cone are as documented, and cast no ray where nothing arrives") {
  Floor floor;
  scene::Light& light = floor.scene.lights[0];
  check_floor(floor);
  light.falloff = scene::Falloff::inverse_square;
  check_floor(floor);
  light.reach = 3.1;
  check_floor(floor);
  light.falloff = scene::Falloff::none;
  check_floor(floor);
  light.kind = scene::LightKind::spot;
  light.inner_degrees = 20;
  light.outer_degrees = 50;
  check_floor(floor);
  light.reach = std::numeric_limits<double>::infinity();
  light.direction = normalised({0.4, -1, 0.2});
  check_floor(floor);
  light.falloff = scene::Falloff::inverse_square;
  check_floor(floor);
}

TEST_CASE("lights: one that no instance is near enough to is left out") {
  Floor floor;
  floor.scene.lights[0].position = {0.5, 20, 0.25};
  floor.scene.lights[0].reach = 19.9;
  const Rendered dark(floor.scene, {});
  CHECK(dark.scene.lights.empty());
  CHECK(dark.scene.skipped.lights_out_of_reach == 1);
  CHECK(dark.frame.stats.shadow_rays == 0);
  floor.scene.lights[0].reach = 20.1;
  const Rendered lit(floor.scene, {});
  CHECK(lit.scene.lights.size() == 1);
  CHECK(lit.frame.stats.shadow_rays > 0);
}

TEST_CASE("lights: a hard cone has no edge between") {
  Floor floor;
  scene::Light& light = floor.scene.lights[0];
  light.kind = scene::LightKind::spot;
  light.position = {0, 2, 0};
  light.inner_degrees = light.outer_degrees = 30;
  const Rendered r(floor.scene, all_aovs());
  for (size_t pixel = 0; pixel < 65 * 65; ++pixel) {
    const double x = r.number(image::Aov::position, 3 * pixel), z = r.number(image::Aov::position, 3 * pixel + 2);
    const double off = std::hypot(x, z) / 2 - std::tan(30 * std::numbers::pi / 180);
    if (r.words(image::Aov::instance)[pixel] != 0 || std::fabs(off) < 1e-6) continue;
    CHECK((r.colour(pixel).x > 0) == (off < 0));
  }
}
