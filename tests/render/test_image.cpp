// Images of known scenes: what a pixel must hold is worked out by hand.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "sys/parallel.h"
#include "worlds.h"

using namespace kd;
using namespace kd::test;
using image::Aov;

namespace {

constexpr double kTolerance = 1e-6;

void expect(Vec3f actual, Vec3d wanted) {
  CHECK(std::fabs(actual.x - wanted.x) < kTolerance);
  CHECK(std::fabs(actual.y - wanted.y) < kTolerance);
  CHECK(std::fabs(actual.z - wanted.z) < kTolerance);
}

/// A cube's scene file, and a material whose every part shows.
struct Stage {
  TempFolder folder;
  std::string cube = unit_cube().write(folder.file("cube.nkd"));
  Material material{{0.1f, 0.2f, 0.3f}, {0.5f, 0.25f, 0.125f}, {0.25f, 0.5f, 1}, 10};

  scene::Part block(const scene::Placement& placement) const {
    scene::Part p = part(0, placement);
    p.material = material;
    return p;
  }
};

}  // namespace

TEST_CASE("image: the AOVs of a cube seen from the front") {
  const Stage stage;
  const Rendered r(scene_of({stage.cube}, {part(0, moved({}))}), all_aovs());
  const size_t centre = r.centre();
  CHECK(r.number(Aov::depth, centre) == 4);
  CHECK(r.number(Aov::position, 3 * centre) == 0.5f);
  CHECK(r.number(Aov::position, 3 * centre + 1) == 0.5f);
  CHECK(r.number(Aov::position, 3 * centre + 2) == 1);
  CHECK(r.number(Aov::normal, 3 * centre) == 0);
  CHECK(r.number(Aov::normal, 3 * centre + 2) == 1);
  CHECK(r.words(Aov::object)[centre] == 0);
  CHECK(r.words(Aov::instance)[centre] == 0);

  // Of every pixel: by the pinhole camera, to float32.
  const double pixel = 2 * std::tan(15 * 3.14159265358979323846 / 180) / 33;
  int wrong = 0, met = 0;
  for (uint32_t y = 0; y < 33; ++y) {
    for (uint32_t x = 0; x < 33; ++x) {
      const double dx = (x - 16.0) * pixel, dy = (16.0 - y) * pixel;
      const double away = std::max(std::fabs(4 * dx), std::fabs(4 * dy));
      if (std::fabs(away - 0.5) < 1e-4) continue;
      const size_t i = size_t{y} * 33 + x;
      const float depth = r.number(Aov::depth, i);
      if (away > 0.5) {
        wrong += !std::isinf(depth) || r.words(Aov::primitive)[i] != 0xffffffffu;
        continue;
      }
      ++met;
      wrong += std::fabs(depth - 4 * std::sqrt(1 + dx * dx + dy * dy)) > 1e-6;
      wrong += std::fabs(r.number(Aov::position, 3 * i) - (0.5 + 4 * dx)) > kTolerance;
      wrong += std::fabs(r.number(Aov::position, 3 * i + 1) - (0.5 + 4 * dy)) > kTolerance;
      wrong += r.words(Aov::primitive)[i] / 2 != 1;  // the two triangles of z = 1
    }
  }
  CHECK(wrong == 0);
  CHECK(met > 100);
  CHECK(r.frame.stats.primary_hits ==
        static_cast<uint64_t>(std::count_if(r.words(Aov::instance).begin(), r.words(Aov::instance).end(),
                                            [](uint32_t w) { return w == 0; })));
}

TEST_CASE("image: Phong's value at a lit point, by hand") {
  const Stage stage;
  auto s = scene_of({stage.cube}, {stage.block(moved({}))});
  s.ambient = {0.5f, 1, 0.25f};
  scene::Light point;
  point.position = {2.5, 0.5, 3};  // from (0.5, 0.5, 1): 45 degrees
  point.colour = {1, 0.5f, 2};
  s.lights = {point};
  const Rendered one(s, {});
  // N.L = cos 45; R is at 45 degrees on the other side, so R.V = cos 45 too.
  const double cosine = std::sqrt(0.5), highlight = std::pow(cosine, 10);
  const Vec3d ambient{0.05, 0.2, 0.075};
  const Vec3d added{0.5 * cosine + 0.25 * highlight, 0.5 * (0.25 * cosine + 0.5 * highlight),
                    2 * (0.125 * cosine + highlight)};
  expect(one.colour(one.centre()), ambient + added);
  CHECK(one.frame.film.colour[4 * one.centre() + 3] == 1);
  expect(one.colour(0), {0, 0, 0});

  // A directional light the same way, and one from behind that adds nothing.
  scene::Light sun;
  sun.kind = scene::LightKind::directional;
  sun.direction = normalised(Vec3d{-1, 0, -1});
  sun.colour = point.colour;
  scene::Light behind = sun;
  behind.direction = {0, 0, 1};
  s.lights = {point, sun, behind};
  const Rendered both(s, {});
  expect(both.colour(both.centre()), ambient + added * 2.0);
}

TEST_CASE("image: emission is added to what the lights leave, and is there without any") {
  const Stage stage;
  auto s = scene_of({stage.cube}, {stage.block(moved({}))});
  Material& material = *s.characters[0].parts[0].material;
  const Rendered black(s, {});
  expect(black.colour(black.centre()), {0, 0, 0});
  material.emission = {3, 0.5f, 0};
  const Rendered glowing(s, {});
  expect(glowing.colour(glowing.centre()), {3, 0.5, 0});
  CHECK(glowing.frame.stats.shadow_rays == 0);
  s.ambient = {0.5f, 1, 0.25f};
  const Rendered ambient(s, {});
  expect(ambient.colour(ambient.centre()), {3.05, 0.7, 0.075});
  scene::Light sun;
  sun.kind = scene::LightKind::directional;
  sun.direction = {0, 0, -1};
  s.lights = {sun};
  const Rendered lit(s, {});
  material.emission = {0, 0, 0};
  const Rendered unlit(s, {});
  const Vec3d without = vec_cast<double>(unlit.colour(unlit.centre()));
  expect(lit.colour(lit.centre()), without + Vec3d{3, 0.5, 0});
}

TEST_CASE("image: an object's own emission") {
  const Stage stage;
  Contents lamp(box_shape({0, 0, 0}, {1023, 1023, 1023}), 10);
  for (Material& m : lamp.materials) m.emission = {0.25f, 8, 1};
  auto s = scene_of({lamp.write(stage.folder.file("lamp.nkd"))}, {part(0, scene::BoxPlacement{})});
  const Rendered r(s, {});
  expect(r.colour(r.centre()), {0.25, 8, 1});
  s.characters[0].parts[0].material = Material{};
  const Rendered dark(s, {});
  expect(dark.colour(dark.centre()), {0, 0, 0});
}

TEST_CASE("image: a shadowed point has its ambient part only") {
  const Stage stage;
  // A small block between the light and the centre of the front face.
  auto s = scene_of({stage.cube}, {stage.block(moved({})), stage.block(moved({1.4, 0.4, 1.9}, {0.2, 0.2, 0.2}))});
  s.ambient = {1, 1, 1};
  scene::Light point;
  point.position = {2.5, 0.5, 3};
  s.lights = {point};
  const Rendered dark(s, {});
  expect(dark.colour(dark.centre()), {0.1, 0.2, 0.3});
  CHECK(dark.frame.stats.shadow_rays > 0);
  // A light before the block is not hidden by it.
  s.lights[0].position = {1.2, 0.5, 1.7};
  const Rendered lit(s, {});
  CHECK(lit.colour(lit.centre()).x > 0.2f);
}

TEST_CASE("image: no surface shadows itself") {
  const Stage stage;
  for (const int bits : {10, 21, 24}) {
    const std::string cube = unit_cube(bits).write(stage.folder.file("b.nkd"));
    for (const Vec3d size : {Vec3d{1, 1, 1}, Vec3d{1e6, 1e6, 1e6}, Vec3d{1e-6, 1e-6, 1e-6}}) {
      auto s = scene_of({cube}, {stage.block(moved({}, size))}, 64);
      s.camera = {{-1.1 * size.x, 1.7 * size.y, 2.3 * size.z}, size * 0.5, {0, 1, 0}, 40};
      scene::Light sun;
      sun.kind = scene::LightKind::directional;
      sun.direction = normalised(Vec3d{1, -0.001, -0.7});  // grazes the top
      s.lights = {sun};
      const Rendered r(s, {});
      int black = 0;
      for (size_t i = 0; i < 64 * 64; ++i) {
        black += r.frame.film.colour[4 * i + 3] == 1 && r.frame.film.colour[4 * i] == 0;
      }
      CHECK(black == 0);
    }
  }
}

TEST_CASE("image: a box or frame placement and the transform that does the same") {
  const Stage stage;
  Contents c = unit_cube();
  c.summary.lattice = {{-1, -2, -4}, {2, 4, 8}, 21};
  c.count_tree();
  const std::string file = c.write(stage.folder.file("c.nkd"));
  // Turned by 90 degrees about z, scaled and moved: x goes to y, y to -x.
  scene::TransformPlacement transform = moved({0.5, 0.5, 0}, {0.5, 0.25, 0.125});
  transform.rotate_degrees = 90;
  const scene::BoxPlacement box{{{1, 0, -0.5}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}};
  auto s = scene_of({file}, {stage.block(transform)}, 65);
  s.camera.position = {2, 3, 4};
  s.lights.resize(1);
  s.lights[0].position = {3, 3, 5};
  const Rendered a(s, all_aovs());
  s.characters[0].parts[0].placement = box;
  const Rendered b(s, all_aovs());
  CHECK(a.frame.stats.primary_hits > 200);
  CHECK(a.words(Aov::primitive) == b.words(Aov::primitive));
  double worst = 0;
  for (size_t i = 0; i < a.frame.film.colour.size(); ++i) {
    worst = std::max(worst, std::fabs(double{a.frame.film.colour[i]} - b.frame.film.colour[i]));
  }
  CHECK(worst < kTolerance);
  s.characters[0].parts[0].placement =
      scene::FramePlacement{{{0.5, 0.5, 0}, {0, 0.5, 0}, {-0.25, 0, 0}, {0, 0, 0.125}}};
  CHECK(same_film(Rendered(s, all_aovs()).frame.film, a.frame.film));
}

TEST_CASE("image: a mirrored cube is as bright as the cube") {
  const Stage stage;
  auto s = scene_of({stage.cube}, {stage.block(moved({}))});
  s.lights.resize(1);
  s.lights[0].position = {0.5, 0.5, 6};
  const Rendered plain(s, all_aovs());
  s.characters[0].parts[0] = stage.block(moved({1, 0, 0}, {-1, 1, 1}));
  const Rendered mirrored(s, all_aovs());
  expect(mirrored.colour(mirrored.centre()), vec_cast<double>(plain.colour(plain.centre())));
  CHECK(plain.words(Aov::instance) == mirrored.words(Aov::instance));
  CHECK(mirrored.number(Aov::normal, 3 * mirrored.centre() + 2) == 1);
  s.characters[0].parts[0] = stage.block(moved({1, 1, 1}, {-1, -1, -1}));
  const Rendered all(s, all_aovs());
  CHECK(all.number(Aov::depth, all.centre()) == 4);
  expect(all.colour(all.centre()), vec_cast<double>(plain.colour(plain.centre())));
}

TEST_CASE("image: gamma on the preview and on the film") {
  const Stage stage;
  auto s = scene_of({stage.cube}, {});
  s.background = {0.25f, 0.5f, 4};
  render::RenderSettings settings;
  settings.preview = true;
  settings.gamma = 2;
  const Rendered linear(s, settings);
  expect(linear.colour(7), {0.25, 0.5, 4});
  CHECK(linear.frame.preview[3 * 7] == 128);      // 0.5 * 255 = 127.5, rounded up
  CHECK(linear.frame.preview[3 * 7 + 1] == 180);  // 180.3
  CHECK(linear.frame.preview[3 * 7 + 2] == 255);
  settings.gamma_on_film = true;
  const Rendered shown(s, settings);
  expect(shown.colour(7), {0.5, std::sqrt(0.5), 2});
  CHECK(shown.frame.preview == linear.frame.preview);
  CHECK(shown.frame.film.colour[4 * 7 + 3] == 0);
  settings.gamma = 1;
  expect(Rendered(s, settings).colour(7), {0.25, 0.5, 4});
}

TEST_CASE("image: the same for 1 and 8 threads, from run to run, and in either layout of triangles") {
  const Stage stage;
  const Contents c(soup_shape(21, 300, Soup::mixed, 3), 21);
  Random random(5);
  std::vector<scene::Part> parts{stage.block(moved({-3, -1.2, -6}, {7, 0.2, 8}))};
  for (int i = 0; i < 20; ++i) {
    scene::BoxPlacement box{{random.vector(1), random.vector(1), random.vector(1), random.vector(1)}};
    parts.push_back(part(1, box));
  }
  auto s = scene_of({stage.cube, c.write(stage.folder.file("soup.nkd"))}, parts, 96);
  s.ambient = {0.1f, 0.1f, 0.1f};
  s.lights.resize(2);
  s.lights[0].position = {4, 5, 6};
  s.lights[1].position = {-4, 5, 6};
  render::RenderSettings settings = all_aovs();
  settings.preview = true;
  std::vector<Rendered> runs;
  for (const unsigned threads : {1u, 8u, 8u}) {
    const ThreadLimit limit(threads);
    runs.emplace_back(s, settings);
  }
  settings.layout = TriangleLayout::compact;
  runs.emplace_back(s, settings);
  CHECK(runs[0].frame.stats.primary_hits > 1000);
  for (const Rendered& r : runs) {
    CHECK(same_film(r.frame.film, runs[0].frame.film));
    CHECK(r.frame.preview == runs[0].frame.preview);
    CHECK(r.frame.stats.shadow_rays == runs[0].frame.stats.shadow_rays);
  }
}
