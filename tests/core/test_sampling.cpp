// Samples of a pixel: stratified in every way that a (0, 2)-net is, distributed like a tent, other for each pixel.
#include <doctest/doctest.h>

#include <set>
#include <vector>

#include "core/sampling.h"

using namespace kd;

namespace {

/// The uniform number that the tent was made of.
double uniform(double t) { return t < 0 ? 0.5 * (t + 1) * (t + 1) : 1 - 0.5 * (1 - t) * (1 - t); }

}  // namespace

TEST_CASE("samples: of each power of two, one lies in every elementary interval") {
  for (uint32_t pixel = 0; pixel < 50; ++pixel) {
    for (uint32_t level = 0; level <= 10; ++level) {
      const uint32_t count = 1u << level;
      for (uint32_t columns_log = 0; columns_log <= level; ++columns_log) {
        const double columns = 1u << columns_log, rows = count / columns;
        std::set<uint32_t> boxes;
        for (uint32_t i = 0; i < count; ++i) {
          const SampleOffset s = sample_offset(pixel * 7919, pixel * 31, i);
          const auto column = static_cast<uint32_t>(uniform(s.x) * columns);
          const auto row = static_cast<uint32_t>(uniform(s.y) * rows);
          boxes.insert(row * static_cast<uint32_t>(columns) + column);
        }
        CHECK(boxes.size() == count);
      }
    }
  }
}

TEST_CASE("samples: the moments of a tent") {
  double sum = 0, squares = 0, product = 0;
  constexpr uint32_t kPixels = 200, kSamples = 1024;
  for (uint32_t pixel = 0; pixel < kPixels; ++pixel) {
    for (uint32_t i = 0; i < kSamples; ++i) {
      const SampleOffset s = sample_offset(pixel, 17, i);
      REQUIRE(std::fabs(s.x) < 1);
      REQUIRE(std::fabs(s.y) < 1);
      sum += s.x + s.y;
      squares += s.x * s.x + s.y * s.y;
      product += s.x * s.y;
    }
  }
  constexpr double kCount = 2.0 * kPixels * kSamples;
  CHECK(std::fabs(sum / kCount) < 1e-4);
  CHECK(squares / kCount == doctest::Approx(1.0 / 6).epsilon(1e-3));
  CHECK(std::fabs(product / kCount) < 1e-3);
}

TEST_CASE("samples: pixels differ, and a pixel's samples do not depend on who asks") {
  std::set<double> first;
  for (uint32_t row = 0; row < 64; ++row) {
    for (uint32_t column = 0; column < 64; ++column) first.insert(sample_offset(column, row, 0).x);
  }
  CHECK(first.size() > 4090);
}
