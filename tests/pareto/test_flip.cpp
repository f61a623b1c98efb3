// FLIP against the authors' own implementation, and against what can be said of it by hand.
#include <doctest/doctest.h>

#include "pareto/flip.h"

using namespace kd;
using namespace kd::bench;

namespace {

constexpr uint32_t kSide = 64;

template <class Colour>
Picture paint(const Colour& colour) {
  Picture p{kSide, kSide, {}};
  for (int y = 0; y < static_cast<int>(kSide); ++y) {
    for (int x = 0; x < static_cast<int>(kSide); ++x) p.pixels.push_back(colour(x, y));
  }
  return p;
}
Picture solid(Vec3f c) {
  return paint([&](int, int) { return c; });
}
Vec3f from_bytes(int r, int g, int b) {
  return {static_cast<float>(r) / 255, static_cast<float>(g) / 255, static_cast<float>(b) / 255};
}
Vec3f gradient_colour(int x, int y) { return from_bytes(4 * x, 4 * y, 2 * (x + y)); }

const Picture& gradient() {
  static const Picture p = paint(gradient_colour);
  return p;
}
const Picture& pattern() {
  static const Picture p =
      paint([](int x, int y) { return from_bytes((x * 7 + y * 3) % 256, (x * x + 5 * y) % 256, (x * y + 11) % 256); });
  return p;
}
const Picture& spotted() {
  static const Picture p = paint([](int x, int y) {
    return x >= 20 && x < 26 && y >= 30 && y < 33 ? Vec3f{1, 0.2f, 0.2f} : gradient_colour(x, y);
  });
  return p;
}
const Picture& redder() {
  static const Picture p = paint([](int x, int y) { return from_bytes(std::min(255, 4 * x + 8), 4 * y, 2 * (x + y)); });
  return p;
}

}  // namespace

TEST_SUITE("FLIP") {
  // What flip-evaluator 1.7 (the authors', from PyPI) gives, in float32, for evaluate(reference, test, "LDR"): the
  // mean, and the map at (32, 32), (22, 31), (19, 29) and (0, 0).
  TEST_CASE("the values are those of the authors' implementation") {
    const struct {
      const char* name;
      const Picture reference, test;
      double mean;
      float at[4];
    } kRows[] = {
        {"black, white", solid({0, 0, 0}), solid({1, 1, 1}), 0.9673452, {.9673883f, .9673883f, .9673883f, .9673883f}},
        {"green, blue", solid({0, 1, 0}), solid({0, 0, 1}), 1, {1, 1, 1, 1}},
        {"a spot", gradient(), spotted(), 0.0095998, {.0105664f, .8994800f, .3076917f, 0}},
        {"a tint", gradient(), redder(), 0.1051806, {.1118868f, .0925561f, .0867214f, .0360534f}},
        {"noise", pattern(), gradient(), 0.7971112, {.6011060f, .9514163f, .8560815f, .0470126f}},
    };
    for (const auto& row : kRows) {
      CAPTURE(row.name);
      const auto map = flip_map(row.reference, row.test);
      const auto at = [&](uint32_t x, uint32_t y) { return map[y * kSide + x]; };
      CHECK(flip(row.reference, row.test) == doctest::Approx(row.mean).epsilon(2e-4));
      CHECK(at(32, 32) == doctest::Approx(row.at[0]).epsilon(1e-3));
      CHECK(at(22, 31) == doctest::Approx(row.at[1]).epsilon(1e-3));
      CHECK(at(19, 29) == doctest::Approx(row.at[2]).epsilon(1e-3));
      CHECK(at(0, 0) == doctest::Approx(row.at[3]).epsilon(1e-3));
    }
  }

  TEST_CASE("an image does not differ from itself") {
    for (const Picture* p : {&gradient(), &pattern()}) CHECK(flip(*p, *p) == 0);
  }

  TEST_CASE("it is symmetric") {
    CHECK(flip(gradient(), spotted()) == flip(spotted(), gradient()));
    CHECK(flip(pattern(), gradient()) == flip(gradient(), pattern()));
  }

  // Section 4.1.4 by hand: lightness alone differs, by 100, so the colour difference is 100^0.7, above the knee; and
  // where nothing has an edge, that is all there is.
  TEST_CASE("black against white") {
    const double green_blue = 41.27604;  // cmax: HyAB of the two, to the power 0.7, as the authors' code has it
    const double knee = 0.4 * green_blue;
    const double expected = 0.95 + (std::pow(100.0, 0.7) - knee) / (green_blue - knee) * 0.05;
    CHECK(flip(solid({0, 0, 0}), solid({1, 1, 1})) == doctest::Approx(expected).epsilon(1e-4));
  }

  TEST_CASE("from further away a spot is seen less, and from far enough not at all") {
    double before = 1;
    for (double pixels_per_degree : {20.0, 67.0, 200.0}) {
      const double difference = flip_map(gradient(), spotted(), pixels_per_degree)[31 * kSide + 22];
      CHECK(difference < before);
      before = difference;
    }
  }

  TEST_CASE("a spot is seen where it is") {
    const auto map = flip_map(gradient(), spotted());
    for (uint32_t y = 0; y < kSide; ++y) {
      for (uint32_t x = 0; x < kSide; ++x) {
        const bool near = x + 21 >= 20 && x < 26 + 21 && y + 21 >= 30 && y < 33 + 21;  // both filters' reach
        if (!near) CHECK(map[y * kSide + x] < 1e-6f);
      }
    }
  }
}

TEST_SUITE("pictures") {
  TEST_CASE("the transfer function of sRGB") {
    const Picture p{3, 1, {{0, 1, 2}, {0.5f, -1, 0.0031308f}, {0.2158605f, 0.001f, 0.99f}}};
    const Picture s = to_srgb8(p);
    CHECK(s.pixels[0] == Vec3f{0, 1, 1});
    CHECK(s.pixels[1] == from_bytes(188, 0, 10));  // IEC 61966-2-1: 0.7354, 0.0405
    CHECK(s.pixels[2] == from_bytes(128, 3, 254));
  }

  TEST_CASE("root mean square") {
    const Picture a{2, 1, {{0, 0, 0}, {1, 1, 1}}}, b{2, 1, {{0, 0, 3}, {1, 1, 1}}};
    CHECK(rmse(a, a) == 0);
    CHECK(rmse(a, b) == doctest::Approx(std::sqrt(9.0 / 6)));
  }
}
