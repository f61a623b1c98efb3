// Rays at vertices and edges: which targets there are, that such a ray crosses one triangle, and what the tests make of
// it.
#include <doctest/doctest.h>

#include "kdbuild/build_source.h"
#include "pareto/fans.h"
#include "pareto/meshes.h"
#include "pareto/render.h"

using namespace kd;
using namespace kd::bench;
using namespace kd::test;

namespace {

using render::TriangleTest;

struct TargetCounts {
  size_t vertices = 0, edges = 0;
};
TargetCounts count(const Targets& targets) {
  TargetCounts out;
  for (const Target& t : targets.all) ++(t.is_edge ? out.edges : out.vertices);
  return out;
}

std::vector<AimedRay> aim_at(const Targets& targets, const std::vector<Corners>& corners, Vec3d camera) {
  return aim(targets, camera, 3.5, [&](uint32_t primitive) { return &corners[primitive]; });
}

}  // namespace

TEST_SUITE("fans") {
  TEST_CASE("a closed mesh has a target at each vertex and each edge") {
    const TargetCounts ball = count(find_targets(data_mesh("icosphere.ply")));
    CHECK(ball.vertices == 642);
    CHECK(ball.edges == 1920);
    const TargetCounts cube = count(find_targets(data_mesh("cube.obj")));
    CHECK(cube.vertices == 8);
    CHECK(cube.edges == 18);
  }

  TEST_CASE("none where a ring is open, turned over or more than one") {
    mesh::Mesh mesh = data_mesh("icosphere.ply");
    const auto remove = [&](size_t i) {
      mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(i));
      mesh.source_primitives.erase(mesh.source_primitives.begin() + static_cast<std::ptrdiff_t>(i));
    };
    SUBCASE("a hole") { remove(100); }
    SUBCASE("a triangle turned over") { std::swap(mesh.triangles[100][0], mesh.triangles[100][1]); }
    SUBCASE("a triangle there twice") {
      mesh.triangles.push_back(mesh.triangles[100]);
      mesh.source_primitives.push_back(1280);
    }
    const TargetCounts left = count(find_targets(mesh));
    CHECK(left.vertices == 642 - 3);
    CHECK(left.edges == 1920 - 3);
  }

  TEST_CASE("vertices that are apart only by their numbers are one") {
    mesh::Mesh mesh = data_mesh("icosphere.ply"), soup = mesh;
    soup.positions.clear();
    for (auto& t : soup.triangles) {
      for (uint32_t& v : t) {
        soup.positions.push_back(mesh.positions[v]);
        v = static_cast<uint32_t>(soup.positions.size() - 1);
      }
    }
    const TargetCounts counts = count(find_targets(soup));
    CHECK(counts.vertices == 642);
    CHECK(counts.edges == 1920);
  }

  // By a test that shares nothing with those under test: double, on the corners themselves. It counts edges as inside,
  // so now and then it sees two.
  TEST_CASE("a ray at a target crosses one triangle of the star, and what is behind is behind") {
    const mesh::Mesh mesh = data_mesh("icosphere.ply");
    const auto corners = corners_of(mesh);
    const ReferenceTracer tracer(corners);
    const Targets targets = find_targets(mesh);
    for (Vec3d camera : {Vec3d{0.1, 0.2, 0.05}, Vec3d{3, 2, 2.5}}) {
      const auto rays = aim_at(targets, corners, camera);
      CHECK(rays.size() > 2000);
      size_t once = 0;
      for (const AimedRay& aimed : rays) {
        size_t met = 0;
        for (const StarTriangle& t : targets.star(targets.all[aimed.target])) {
          ReferenceHit hit;
          if (!meets(to_ray(aimed.ray), corners[t.primitive], hit)) continue;
          ++met;
          CHECK(hit.t < aimed.t_behind);
        }
        REQUIRE(met >= 1);
        once += met == 1;
        CHECK(tracer.closest_hit(to_ray(aimed.ray)).t < aimed.t_behind);
      }
      CHECK(once >= rays.size() * 999 / 1000);
    }
  }

  TEST_CASE("a silhouette is no target") {
    const mesh::Mesh mesh = data_mesh("cube.obj");  // the unit cube
    const auto corners = corners_of(mesh);
    const Targets targets = find_targets(mesh);
    // Before a corner: it and the one opposite, three edges at each, and the diagonals of all faces.
    CHECK(aim_at(targets, corners, {3, 2.5, 2.8}).size() == 2 + 6 + 6);
    // Before a face: not its corners and edges, but all else, which faces away.
    CHECK(aim_at(targets, corners, {0.51, 0.52, 50}).size() == 4 + 8 + 6);
  }

  TEST_CASE("the exact test meets one triangle, always; Moller-Trumbore misses some and counts some twice") {
    Workshop workshop;
    const mesh::Mesh mesh = data_mesh("icosphere.ply");
    const Targets targets = find_targets(mesh);
    FanCounts mt_sum;
    for (int bits : {10, 16, 21, 24}) {
      CAPTURE(bits);
      const auto object = nkd::ObjectFile::open(workshop.compile(source_root() / "data" / "icosphere.ply", bits));
      REQUIRE(object);
      const ObjectTriangles triangles(*object);
      Corners corners;
      const auto find = [&](uint32_t primitive) -> const Corners* {
        if (triangles.index_of(primitive) == kNoTriangle) return nullptr;
        corners = triangles.corners(primitive);
        return &corners;
      };
      for (Vec3d camera : {Vec3d{0.1, 0.2, 0.05}, Vec3d{3, 2, 2.5}, Vec3d{-20, 11, 7}}) {
        const auto rays = aim(targets, camera, 3.5, find);
        CHECK(rays.size() > 1500);
        const FanCounts exact = count_fans(targets, rays, *object, TriangleTest::exact);
        CHECK(exact.rays == rays.size());
        CHECK(exact.missed == 0);
        CHECK(exact.twice == 0);
        const FanCounts woop = count_fans(targets, rays, *object, TriangleTest::woop);
        CHECK(woop.missed == 0);
        const FanCounts mt = count_fans(targets, rays, *object, TriangleTest::moller_trumbore);
        mt_sum = {mt_sum.rays + mt.rays, mt_sum.missed + mt.missed, mt_sum.twice + mt.twice};
      }
    }
    CHECK(mt_sum.missed > mt_sum.rays / 1000);
    CHECK(mt_sum.twice > mt_sum.rays / 1000);
  }

  TEST_CASE("a target whose star lost a triangle is none on that form") {
    const mesh::Mesh mesh = data_mesh("icosphere.ply");
    const auto corners = corners_of(mesh);
    const Targets targets = find_targets(mesh);
    const auto all = aim_at(targets, corners, {0, 0, 0.1});
    const auto fewer = aim(targets, {0, 0, 0.1}, 3.5,
                           [&](uint32_t primitive) { return primitive == 7 ? nullptr : &corners[primitive]; });
    CHECK(all.size() == 642 + 1920);
    CHECK(fewer.size() == all.size() - 6);  // three vertices, three edges
  }
}
