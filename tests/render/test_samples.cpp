// Several samples a pixel: what they converge to, and what they leave alone.
#include <doctest/doctest.h>

#include <cmath>

#include "worlds.h"

using namespace kd;
using namespace kd::test;

namespace {

struct World {
  TempFolder folder;
  scene::Scene scene;

  explicit World(uint32_t size) {
    scene::TransformPlacement turned = moved({0.3, 0.1, 0});
    turned.rotate_axis = {1, 2, 3};
    turned.rotate_degrees = 33;
    scene = scene_of({unit_cube().write(folder.file("cube.nkd"))}, {part(0, turned)}, size);
    scene.ambient = {0.2f, 0.4f, 0.6f};
    scene.background = {1, 0.5f, 0.25f};
    scene.lights.push_back({});
    scene.lights[0].position = {3, 4, 5};
  }
};

render::RenderSettings samples(uint32_t count) {
  render::RenderSettings settings;
  settings.samples = count;
  return settings;
}

/// Coverage at pixel (column, row) of a film `fine` times finer, filtered by a tent of one coarse pixel.
double filtered(const std::vector<float>& rgba, int side, int fine, int column, int row, int channel) {
  double sum = 0, weights = 0;
  const double centre_x = (column + 0.5) * fine, centre_y = (row + 0.5) * fine;
  for (int y = (row - 1) * fine; y < (row + 2) * fine; ++y) {
    for (int x = (column - 1) * fine; x < (column + 2) * fine; ++x) {
      if (x < 0 || y < 0 || x >= side || y >= side) continue;
      const double weight = std::max(0.0, 1 - std::fabs(x + 0.5 - centre_x) / fine) *
                            std::max(0.0, 1 - std::fabs(y + 0.5 - centre_y) / fine);
      sum += weight * rgba[4 * static_cast<size_t>(y * side + x) + static_cast<size_t>(channel)];
      weights += weight;
    }
  }
  return sum / weights;
}

}  // namespace

TEST_CASE("samples: they converge to a finer film under the filter") {
  constexpr int kSide = 32, kFine = 24;
  const Rendered fine(World(kSide * kFine).scene, samples(1));
  double error[2] = {};
  const uint32_t counts[] = {4, 256};
  for (int run = 0; run < 2; ++run) {
    const Rendered coarse(World(kSide).scene, samples(counts[run]));
    for (int row = 1; row < kSide - 1; ++row) {
      for (int column = 1; column < kSide - 1; ++column) {
        for (int channel = 0; channel < 4; ++channel) {
          const double expected = filtered(fine.frame.film.colour, kSide * kFine, kFine, column, row, channel);
          const size_t at = 4 * static_cast<size_t>(row * kSide + column) + static_cast<size_t>(channel);
          const double off = coarse.frame.film.colour[at] - expected;
          error[run] += off * off / (4 * (kSide - 2) * (kSide - 2));
        }
      }
    }
    MESSAGE(counts[run] << " samples: RMSE " << std::sqrt(error[run]));
  }
  CHECK(std::sqrt(error[1]) < 2e-3);
  CHECK(std::sqrt(error[1]) < std::sqrt(error[0]) / 8);
}

TEST_CASE("samples: AOVs stay those of the pixel's centre") {
  const World world(33);
  render::RenderSettings settings = all_aovs();
  const Rendered one(world.scene, settings);
  settings.samples = 5;
  const Rendered five(world.scene, settings);
  for (size_t i = 0; i < one.frame.film.aovs.size(); ++i) {
    CHECK(one.frame.film.aovs[i].words == five.frame.film.aovs[i].words);
  }
  CHECK(one.frame.film.colour != five.frame.film.colour);
  CHECK(five.frame.stats.primary_rays == 6 * one.frame.stats.primary_rays);
}

TEST_CASE("samples: the same whatever strips the frame is rendered in") {
  const World world(33);
  const auto loaded = render::load_scene(world.scene, samples(3));
  const auto cpu = render::cpu_device().backend->open(*loaded, samples(3), 0);
  render::Frame whole, parts;
  for (render::Frame* frame : {&whole, &parts}) frame->film.colour.resize(4 * 33 * 33);
  REQUIRE((*cpu)->render({0, 33}, whole, {}));
  for (uint32_t row = 0; row < 33; row += 11) REQUIRE((*cpu)->render({row, 11}, parts, {}));
  CHECK(whole.film.colour == parts.film.colour);
}
