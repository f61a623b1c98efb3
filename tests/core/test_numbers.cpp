// The small parts: lattice, packing, node bits, powers, statistics.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <limits>

#include "core/arithmetic.h"
#include "core/node.h"
#include "core/object_view.h"
#include "core/power.h"
#include "core/shapes.h"

using namespace kd;
using namespace kd::test;

TEST_CASE("arithmetic: signs, reciprocals, rounding to a grid") {
  CHECK_FALSE(signs_differ(1, 2, 0.0f));
  CHECK_FALSE(signs_differ(-1, -2, -0.0f));
  for (const std::array<float, 3> f : {std::array{-1.0f, 2.0f, 3.0f}, {1.0f, -2.0f, 3.0f}, {1.0f, 2.0f, -3.0f}}) {
    CHECK(signs_differ(f[0], f[1], f[2]));
    CHECK(signs_differ(-f[0], -f[1], -f[2]));
  }
  Random random(3);
  long double worst = 0;
  for (int i = 0; i < 200000; ++i) {
    const double x =
        std::ldexp(random.real(1, 2), static_cast<int>(random.integer(0, 200)) - 100) * (random.chance(0.5) ? 1 : -1);
    worst = std::max(worst, std::fabs(static_cast<long double>(reciprocal(x)) * x - 1));
    const double grid = power_of_two(static_cast<int>(random.integer(0, 40)) - 30);
    const double y = random.real(-1, 1) * std::ldexp(grid, static_cast<int>(random.integer(0, 51)));
    REQUIRE(rounded_to(y, grid) == std::nearbyint(y / grid) * grid);
  }
  CHECK(worst <= 0x1p-52L);
}

TEST_CASE("lattice: there and back is off by at most half a step") {
  for (const int bits : {1, 10, 12, 16, 18, 21, 24}) {
    for (const double size : {1.0, 1e-12, 1e12}) {
      CAPTURE(bits);
      CAPTURE(size);
      Random random(4);
      const Lattice lattice{random.vector(size), Vec3d{1, 1e-3, 7} * size, bits};
      const Vec3d step = lattice.step();
      double worst = 0;
      for (int i = 0; i < 20000; ++i) {
        const Vec3d p = lattice.origin + Vec3d{random.unit(), random.unit(), random.unit()} * lattice.extent;
        const Vec3u q = lattice.to_lattice(p);
        const Vec3d back = lattice.to_model(q);
        for (int axis = 0; axis < 3; ++axis) {
          REQUIRE(q[axis] <= lattice_max(bits));
          worst = std::max(worst, std::fabs(back[axis] - p[axis]) / (step[axis] + size * 0x1p-45));
        }
      }
      CHECK(worst <= 0.5);
      CHECK(worst > 0.45);
      CHECK(lattice.to_lattice(lattice.origin) == Vec3u{0, 0, 0});
      const uint32_t top = lattice_max(bits);
      CHECK(lattice.to_lattice(lattice.origin + lattice.extent) == Vec3u{top, top, top});
    }
  }
}

TEST_CASE("lattice: a lattice point comes back as itself") {
  for (const int bits : {1, 10, 12, 16, 18, 21, 24}) {
    Random random(6);
    const Lattice lattice{{-3, 100, 1e3}, {1e-2, 50, 7e5}, bits};
    for (int i = 0; i < 10000; ++i) {
      const Vec3u q = random.point(lattice_max(bits));
      REQUIRE(lattice.to_lattice(lattice.to_model(q)) == q);
    }
  }
}

TEST_CASE("lattice: axes without extent") {
  const Lattice flat{{1, 2, 3}, {4, 0, 8}, 10};
  CHECK(flat.cube().hi == Vec3u{1023, 0, 1023});
  CHECK(flat.step().y == flat.step().z);
  CHECK(flat.to_lattice({3, 2, 5}).y == 0);
  CHECK(flat.to_model({0, 0, 1023}) == Vec3d{1, 2, 11});
  CHECK_FALSE(is_singular(flat.frame()));
  const Lattice point{{1, 2, 3}, {0, 0, 0}, 21};
  CHECK(point.cube().hi == Vec3u{0, 0, 0});
  CHECK_FALSE(is_singular(point.frame()));
}

TEST_CASE("rounding up to float32") {
  CHECK(rounded_up(1.0) == 1.0f);
  CHECK(rounded_up(1 + 0x1p-50) == 1 + 0x1p-23f);
  CHECK(rounded_up(-1 - 0x1p-50) == -1.0f);
  CHECK(rounded_up(-1 + 0x1p-50) == -1 + 0x1p-24f);
  CHECK(rounded_up(0.0) == 0.0f);
  CHECK(rounded_up(1e-60) == std::numeric_limits<float>::denorm_min());
  CHECK(rounded_up(-1e-60) == 0.0f);
  CHECK(rounded_up(0.75f) == 0.75f);
}

TEST_CASE("packed triples: every number of bits, in as few bytes as hold them") {
  CHECK(triple_bytes(1) == 1);
  CHECK(triple_bytes(10) == 4);
  CHECK(triple_bytes(21) == 8);
  CHECK(triple_bytes(22) == 9);
  CHECK(triple_bytes(24) == 9);
  CHECK(triple_bytes(32) == 12);
  for (int bits = 1; bits <= 32; ++bits) {
    CAPTURE(bits);
    Random random(static_cast<uint64_t>(bits));
    const auto top = static_cast<uint32_t>((uint64_t{1} << bits) - 1);
    std::vector<Vec3u> points;
    for (uint32_t i = 0; i < 8; ++i) points.push_back({i & 1 ? top : 0, i & 2 ? top : 0, i & 4 ? top : 0});
    for (int i = 0; i < 1000; ++i) points.push_back(random.point(top));
    const std::vector<uint8_t> section = pack_triples(points, bits);
    REQUIRE(is_triples(section.size(), bits));
    REQUIRE(triple_count(section.size(), bits) == points.size());
    const PackedTriples packed{section.data(), bits};
    for (size_t i = 0; i < points.size(); ++i) REQUIRE(packed[i] == points[i]);
    CHECK(std::count(section.end() - kTripleMargin, section.end(), 0) == kTripleMargin);
    CHECK_FALSE(is_triples(kTripleMargin - 1, bits));
    CHECK(triple_count(kTripleMargin - 1, bits) == 0);
    if (bits > 2) CHECK_FALSE(is_triples(section.size() + 1, bits));
  }
  // As documented: little-endian, x in the lowest bits.
  const std::vector<Vec3u> one{{0x123, 0x456, 0x789}};
  const std::vector<uint8_t> bytes = pack_triples(one, 12);
  CHECK(std::equal(bytes.begin(), bytes.begin() + 5, std::array<uint8_t, 5>{0x23, 0x61, 0x45, 0x89, 0x07}.begin()));

  const std::vector<Vec3u> vertices{{0, 1, 2}, {3, 4, 5}}, corners{{1, 0, 1}};
  const std::vector<uint8_t> packed_vertices = pack_triples(vertices, 24), packed_corners = pack_triples(corners, 1);
  TriangleVertices t;
  PackedTriangles{{packed_corners.data(), 1}, {packed_vertices.data(), 24}}.expand(0, t);
  CHECK(t.a == Vec3f{3, 4, 5});
  CHECK(t.b == Vec3f{0, 1, 2});
  CHECK(t.c == t.a);
}

TEST_CASE("node: bits as stored") {
  const Node inner = make_inner(2, lattice_max(24), kMaxChild - 1);
  CHECK_FALSE(is_leaf(inner));
  CHECK(split_axis(inner) == 2);
  CHECK(split_plane(inner) == 16777215.0f);
  CHECK(child_of(inner, 0) == kMaxChild - 1);
  CHECK(child_of(inner, 1) == kMaxChild);
  CHECK(make_inner(1, 1, 2) == Node{0x3f800000, 2 << 5 | 1});
  CHECK(child_of(make_inner(1, 1, 7, kLowerEmpty), 0) == kEmptyLeaf);
  CHECK(child_of(make_inner(1, 1, 7, kLowerEmpty), 1) == 8);
  CHECK(child_of(make_inner(1, 1, 7, kUpperEmpty), 0) == 7);
  CHECK(child_of(make_inner(1, 1, 7, kUpperEmpty), 1) == kEmptyLeaf);
  CHECK_FALSE(is_leaf(make_inner(2, 1, 7, kUpperEmpty)));
  const Node leaf = make_leaf(0xfffffff0, kMaxLeafReferences);
  CHECK(is_leaf(leaf));
  CHECK(first_reference(leaf) == 0xfffffff0);
  CHECK(reference_count(leaf) == kMaxLeafReferences);
  CHECK(is_leaf(Node{}));
  CHECK(reference_count(Node{}) == 0);
  for (uint32_t plane : {0u, 1u, 12345u, (1u << 24) - 1}) {
    CHECK(static_cast<uint32_t>(split_plane(make_inner(0, plane, 2))) == plane);
  }
}

TEST_CASE("power: against std::pow, to 1e-13, and 3e-13 at the ends of the range") {
  Random random(1);
  double worst = 0, worst_at_ends = 0;
  const auto compare = [&](double x, double y) {
    const double expected = std::pow(x, y);
    if (expected < 1e-300 || expected > 1e300) return;
    double& bound = expected > 1e-150 && expected < 1e150 ? worst : worst_at_ends;
    bound = std::max(bound, std::fabs(exact_pow(x, y) / expected - 1));
  };
  for (int i = 0; i < 300000; ++i) {
    compare(random.unit(), random.real(0, 400));                          // highlights
    compare(random.real(0, 4), 1 / random.real(0.5, 4));                  // gamma
    compare(std::pow(10.0, random.real(-100, 100)), random.real(-3, 3));  // wide
    compare(1 + random.real(-1e-6, 1e-6), random.real(-1e6, 1e6));        // next to 1
  }
  CHECK(worst <= 1e-13);
  CHECK(worst_at_ends <= 3e-13);
}

TEST_CASE("power: edges") {
  CHECK(exact_pow(0, 0) == 1);
  CHECK(exact_pow(5, 0) == 1);
  CHECK(exact_pow(0, 2) == 0);
  CHECK(exact_pow(0, -2) == HUGE_VAL);
  CHECK(exact_pow(DBL_MIN / 2, 2) == 0);
  CHECK(exact_pow(1, 1e300) == 1);
  CHECK(exact_pow(1, -123.25) == 1);
  CHECK(exact_pow(2, 10) == 1024);
  CHECK(exact_pow(2, 1023) == std::ldexp(1.0, 1023));
  CHECK(exact_pow(2, 1024) == HUGE_VAL);
  CHECK(exact_pow(2, -1022) == DBL_MIN);
  CHECK(exact_pow(2, -1e9) == 0);
  CHECK(exact_pow(10, 1e300) == HUGE_VAL);
  CHECK(exact_pow(0.5, 1e300) == 0);
  CHECK(exact_exp2(1023.75) == doctest::Approx(std::exp2(1023.75)).epsilon(1e-13));
  CHECK(exact_log2(1) == 0);
  CHECK(exact_log2(8) == 3);
  CHECK(exact_log2(DBL_MAX) == doctest::Approx(1024));
}

TEST_CASE("vec: lengths and finiteness at the ends of the range") {
  for (const double size : {1e-300, 1e-150, 1.0, 1e150, 1e300}) {
    CHECK(length(normalised({size, -2 * size, 2 * size})) == doctest::Approx(1));
  }
  CHECK(normalised({0, 0, 0}) == Vec3d{0, 0, 0});
  CHECK(is_finite({1e308, 1e308, 1e308}));
  CHECK_FALSE(is_finite({0, 0, std::nan("")}));
  CHECK_FALSE(is_finite({-HUGE_VAL, 0, 0}));
  CHECK(cross(Vec3d{1, 0, 0}, Vec3d{0, 1, 0}) == Vec3d{0, 0, 1});
}
