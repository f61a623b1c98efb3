// Halves of meshes, and parts on one lattice.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "mesh/lattice_fit.h"
#include "mesh/normalise.h"
#include "mesh/split.h"

using namespace kd;
using namespace kd::mesh;

namespace {

/// A bent sheet of 2 n^2 triangles whose coordinates are no multiples of a lattice step.
Mesh sheet(uint32_t n, double step) {
  Mesh mesh;
  for (uint32_t i = 0; i <= n; ++i) {
    for (uint32_t k = 0; k <= n; ++k) mesh.positions.push_back({i * step, k * step * 0.7, std::sin(i * k * step)});
  }
  for (uint32_t i = 0; i < n; ++i) {
    for (uint32_t k = 0; k < n; ++k) {
      const uint32_t a = i * (n + 1) + k, b = a + n + 1;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  }
  mesh.source_primitives.resize(mesh.triangles.size());
  std::iota(mesh.source_primitives.begin(), mesh.source_primitives.end(), 0u);
  return mesh;
}

}  // namespace

TEST_CASE("split: halves by the median, in order, with all triangles") {
  for (const uint32_t n : {1u, 3u, 20u}) {
    const Mesh mesh = sheet(n, 0.37);
    const auto [low, high] = split_in_halves(mesh);
    CHECK(low.triangles.size() == n * n);
    CHECK(high.triangles.size() == n * n);
    CHECK(std::is_sorted(low.source_primitives.begin(), low.source_primitives.end()));
    CHECK(std::is_sorted(high.source_primitives.begin(), high.source_primitives.end()));
    std::vector<uint32_t> all = low.source_primitives;
    all.insert(all.end(), high.source_primitives.begin(), high.source_primitives.end());
    std::sort(all.begin(), all.end());
    CHECK(all == mesh.source_primitives);
    for (const Mesh* half : {&low, &high}) {
      for (size_t t = 0; t < half->triangles.size(); ++t) {
        for (size_t k = 0; k < 3; ++k) {
          CHECK(half->positions[half->triangles[t][k]] ==
                mesh.positions[mesh.triangles[half->source_primitives[t]][k]]);
        }
      }
    }
  }
  const auto [left, right] = split_in_halves(sheet(20, 0.37));
  CHECK(bounds(left).hi.x <= bounds(right).lo.x + 0.38);
}

TEST_CASE("split: halves where centroids coincide or are no numbers") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const Vec3d odd : {Vec3d{1, 1, 1}, Vec3d{nan, 0, 0}, Vec3d{inf, -inf, nan}, Vec3d{1.7e308, 1.7e308, 0}}) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {3, 0, 0}, odd};
    mesh.triangles.assign(5, {0, 1, 2});
    mesh.source_primitives = {0, 1, 2, 3, 4};
    const auto [low, high] = split_in_halves(mesh);
    CHECK(low.source_primitives == std::vector<uint32_t>{0, 1});
    CHECK(high.source_primitives == std::vector<uint32_t>{2, 3, 4});
  }
}

TEST_CASE("normalise: parts of a mesh whose vertices were placed share its lattice, bit for bit") {
  Mesh whole = sheet(25, 0.123456789);
  const Mesh* const meshes[] = {&whole};
  const LatticeFit fit(meshes);
  for (const int bits : {4, 10, 21, 24}) {
    const LatticeMesh all = normalise(whole, bits);
    const Lattice lattice = fit.lattice(bits);
    whole.lattice_points = fit.place(0, lattice);
    const auto [low, high] = split_in_halves(whole);
    const std::array halves{normalise(low, lattice), normalise(high, lattice)};
    std::map<uint32_t, std::array<Vec3u, 3>> corners;  // of the whole's triangles, by their numbers in the source
    for (size_t t = 0; t < all.triangles.size(); ++t) {
      for (size_t k = 0; k < 3; ++k) corners[all.kept[t]][k] = all.vertices[all.triangles[t][k]];
    }
    size_t compared = 0;
    for (size_t h = 0; h < 2; ++h) {
      const LatticeMesh& half = halves[h];
      const Mesh& source = h == 0 ? low : high;
      CHECK(half.lattice.origin == all.lattice.origin);
      CHECK(half.lattice.extent == all.lattice.extent);
      CHECK(half.lattice.bits == all.lattice.bits);
      for (size_t t = 0; t < half.triangles.size(); ++t) {
        const auto& expected = corners.at(source.source_primitives[half.kept[t]]);
        for (size_t k = 0; k < 3; ++k) compared += half.vertices[half.triangles[t][k]] == expected[k];
      }
    }
    CHECK(compared == 3 * all.triangles.size());
    CHECK(normalise(whole, lattice).vertices == all.vertices);
    whole.lattice_points.clear();
  }
}

TEST_CASE("split: a neighbourhood is the nearest triangles, in order") {
  const Mesh mesh = sheet(20, 0.37);
  const auto centre = [&](uint32_t t) {
    const auto& c = mesh.triangles[t];
    return (mesh.positions[c[0]] + mesh.positions[c[1]] + mesh.positions[c[2]]) * (1.0 / 3);
  };
  for (const uint32_t seed : {0u, 399u, 799u}) {
    const auto distance = [&](uint32_t t) {
      const Vec3d d = centre(t) - centre(seed);
      return std::max({std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)});
    };
    for (const size_t count : {1u, 7u, 100u, 800u, 5000u}) {
      const Mesh near = neighbourhood(mesh, seed, count);
      const std::vector<uint32_t>& taken = near.source_primitives;
      REQUIRE(taken.size() == std::min(count, mesh.triangles.size()));
      CHECK(std::is_sorted(taken.begin(), taken.end()));
      CHECK(std::binary_search(taken.begin(), taken.end(), seed));
      double furthest = 0;
      for (const uint32_t t : taken) furthest = std::max(furthest, distance(t));
      size_t nearer = 0;
      for (uint32_t t = 0; t < mesh.triangles.size(); ++t) nearer += distance(t) < furthest - 1e-6;
      CHECK(nearer <= taken.size());
      CHECK(near.positions[near.triangles[0][0]] == mesh.positions[mesh.triangles[taken[0]][0]]);
    }
  }
}
