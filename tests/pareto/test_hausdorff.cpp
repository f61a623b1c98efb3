// Distances between surfaces, where geometry says what they are.
#include <doctest/doctest.h>

#include "mesh/normalise.h"
#include "pareto/hausdorff.h"
#include "pareto/meshes.h"

using namespace kd;
using namespace kd::bench;
using namespace kd::test;

namespace {

Hausdorff between(const std::vector<Corners>& a, const std::vector<Corners>& b, bool related = true) {
  const ReferenceTracer ta(a), tb(b);
  return hausdorff({ta, [&](uint32_t i) { return related && i < b.size() ? &tb.triangles()[i] : nullptr; }},
                   {tb, [&](uint32_t i) { return related && i < a.size() ? &ta.triangles()[i] : nullptr; }}, 5000);
}

std::vector<Corners> moved(std::vector<Corners> triangles, Vec3d by) {
  for (Corners& c : triangles) {
    for (Vec3d& p : c) p = p + by;
  }
  return triangles;
}

}  // namespace

TEST_SUITE("the Hausdorff distance") {
  TEST_CASE("a surface lies on itself, and a cube that is moved square to a face as far off as that") {
    const auto cube = corners_of(data_mesh("cube.obj"));
    CHECK(between(cube, cube).distance() < 1e-15);
    const Hausdorff h = between(cube, moved(cube, {0.01, 0, 0}));
    CHECK(h.to_form == doctest::Approx(0.01).epsilon(1e-9));
    CHECK(h.to_source == doctest::Approx(0.01).epsilon(1e-9));
    CHECK(h.samples > 2 * 5000);
  }

  // A triangle and half of it: all of the half lies on the whole, but the whole reaches further than the half.
  TEST_CASE("it has two directions") {
    const std::vector<Corners> whole{{Vec3d{0, 0, 0}, {2, 0, 0}, {0, 1, 0}}},
        half{{Vec3d{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    const Hausdorff h = between(whole, half);
    CHECK(h.to_form == doctest::Approx(1));  // from (2, 0) to (1, 0)
    CHECK(h.to_source < 1e-15);
  }

  TEST_CASE("a start that is no triangle changes nothing") {
    const auto ball = corners_of(data_mesh("icosphere.ply"));
    auto dented = moved(ball, {0, 0, 0});
    for (Corners& c : dented) c[0] = c[0] * 0.97;
    CHECK(between(ball, dented, true).to_form == doctest::Approx(between(ball, dented, false).to_form));
  }

  // No point of a triangle moves further than the corner that moves most; and for such a mesh the distance is of that
  // order.
  TEST_CASE("a quantised surface is within the largest displacement") {
    const mesh::Mesh mesh = data_mesh("icosphere.ply");
    for (int bits : {6, 8, 10, 16, 21}) {
      CAPTURE(bits);
      const mesh::LatticeMesh quantised = mesh::normalise(mesh, bits);
      REQUIRE(quantised.collapsed_triangles == 0);
      std::vector<Corners> corners;
      for (const auto& t : quantised.triangles) {
        corners.push_back({});
        for (size_t k = 0; k < 3; ++k) corners.back()[k] = quantised.lattice.to_model(quantised.vertices[t[k]]);
      }
      const double distance = between(corners_of(mesh), corners).distance();
      CHECK(distance <= quantised.max_displacement * (1 + 1e-12));
      CHECK(distance >= 0.2 * quantised.max_displacement);
    }
  }
}
