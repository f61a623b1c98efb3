// Cleaning and topology: each fault alone, and the counts of the real meshes, which another program made.
#include <doctest/doctest.h>

#include <filesystem>
#include <limits>
#include <numeric>

#include "mesh/clean.h"
#include "mesh/read_mesh.h"
#include "mesh/topology.h"

using namespace kd;
using namespace kd::mesh;

namespace {

using Triangles = std::vector<std::array<uint32_t, 3>>;

Mesh make(std::vector<Vec3d> positions, Triangles triangles) {
  Mesh mesh;
  mesh.positions = std::move(positions);
  mesh.triangles = std::move(triangles);
  mesh.source_primitives.resize(mesh.triangles.size());
  std::iota(mesh.source_primitives.begin(), mesh.source_primitives.end(), 0u);
  return mesh;
}

const std::vector<Vec3d> kTetrahedron{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const Triangles kTetrahedronFaces{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

}  // namespace

TEST_CASE("clean: a sound mesh stays as it is") {
  Mesh mesh = make(kTetrahedron, kTetrahedronFaces);
  const CleanReport report = clean(mesh);
  CHECK(mesh.triangles == kTetrahedronFaces);
  CHECK(report.non_finite == FaceFault{});
  CHECK(report.degenerate == FaceFault{});
  CHECK(report.duplicate == FaceFault{});
  CHECK(report.opposite == FaceFault{});
}

TEST_CASE("clean: each fault is counted once, with its first, and every array follows") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  // 4 and 5 are where 0 is.
  Mesh mesh = make({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}, {-0.0, 0, 0}, {0, -0.0, 0}, {nan, 0, 0}, {0, inf, 0}},
                   {{0, 1, 2},    // sound
                    {6, 1, 2},    // not finite
                    {0, 0, 1},    // one corner twice
                    {4, 5, 1},    // two corners in one place
                    {0, 1, 3},    // on a line
                    {1, 2, 4},    // the first again
                    {2, 1, 0},    // its back
                    {5, 2, 1},    // its back again
                    {7, 7, 7},    // not finite, and degenerate too
                    {1, 3, 2}});  // sound
  mesh.materials.resize(1);
  mesh.material_ids = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  mesh.normal_indices.assign(10, {kNoIndex, kNoIndex, kNoIndex});
  mesh.normal_indices[9] = {1, 2, 3};
  const CleanReport report = clean(mesh);
  CHECK(report.non_finite == FaceFault{2, 1});
  CHECK(report.degenerate == FaceFault{3, 2});
  CHECK(report.duplicate == FaceFault{2, 5});
  CHECK(report.opposite == FaceFault{1, 6});
  CHECK(mesh.source_primitives == std::vector<uint32_t>{0, 6, 9});
  CHECK(mesh.material_ids == std::vector<uint16_t>{0, 6, 9});
  CHECK(mesh.normal_indices.back() == std::array<uint32_t, 3>{1, 2, 3});
  CHECK(mesh.triangles.back() == std::array<uint32_t, 3>{1, 3, 2});
}

TEST_CASE("clean: magnitude does not change what is degenerate") {
  for (const double scale : {1.0, 1e-200, 1e-300, 1e200, 1.7e308}) {
    CAPTURE(scale);
    Mesh mesh = make({{-scale, -scale, 0}, {scale, -scale, 0}, {0, scale, 0}, {scale, scale, 0}, {0, 0, 0}},
                     {{0, 1, 2}, {0, 4, 3}, {0, 1, 3}});
    const CleanReport report = clean(mesh);
    CHECK(report.degenerate == FaceFault{1, 1});
    CHECK(report.non_finite.count == 0);
    CHECK(mesh.triangles.size() == 2);
  }
  Mesh needle = make({{0, 0, 0}, {1, 0, 0}, {1, 1e-310, 0}, {5e-324, 0, 0}, {0, 5e-324, 0}}, {{0, 1, 2}, {0, 3, 4}});
  CHECK(clean(needle).degenerate.count == 0);
}

TEST_CASE("clean: many copies of both sides") {
  Triangles triangles;
  for (int i = 0; i < 200000; ++i) triangles.push_back({0, 1, 2});
  for (int i = 0; i < 200000; ++i) triangles.push_back({0, 2, 1});
  Mesh mesh = make(kTetrahedron, triangles);
  const CleanReport report = clean(mesh);
  CHECK(report.duplicate == FaceFault{399998, 1});
  CHECK(report.opposite == FaceFault{1, 200000});
  CHECK(mesh.triangles.size() == 2);
}

TEST_CASE("clean: an empty mesh") {
  Mesh mesh;
  clean(mesh);
  CHECK(mesh.triangles.empty());
  CHECK_FALSE(topology(mesh).closed);
}

TEST_CASE("topology: closed, open, non-manifold and inconsistent") {
  const Topology closed = topology(make(kTetrahedron, kTetrahedronFaces));
  CHECK(closed.vertices == 4);
  CHECK(closed.edges == 6);
  CHECK(closed.components == 1);
  CHECK(closed.closed);

  const Topology open = topology(make(kTetrahedron, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}}));
  CHECK(open.boundary_edges == 3);
  CHECK_FALSE(open.closed);

  const Topology turned = topology(make(kTetrahedron, {{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}));
  CHECK(turned.inconsistent_edges == 3);
  CHECK(turned.closed);

  // Three triangles around one edge, the third over vertices of its own, and a fourth apart.
  const Topology fan = topology(make({{0, 0, 0},
                                      {0, 0, 1},
                                      {1, 0, 0},
                                      {0, 1, 0},
                                      {-1, 0, 0},
                                      {-0.0, 0, 0},
                                      {0, 0, 1},
                                      {9, 0, 0},
                                      {9, 1, 0},
                                      {9, 0, 1},
                                      {5, 5, 5}},
                                     {{0, 1, 2}, {0, 1, 3}, {5, 6, 4}, {7, 8, 9}}));
  CHECK(fan.vertices == 8);
  CHECK(fan.edges == 10);
  CHECK(fan.non_manifold_edges == 1);
  CHECK(fan.boundary_edges == 9);
  CHECK(fan.components == 2);
}

TEST_CASE("clean, topology: the real meshes have the counts of their table") {
  struct Row {
    const char* file;
    uint64_t vertices, triangles, degenerate, repeated, boundary_edges, non_manifold_edges;
  };
  for (const Row& row :
       {Row{"sibenik.ply", 40218, 75284, 7, 153, 8204, 799}, Row{"sponza.ply", 39624, 76154, 64, 10, 3810, 479},
        Row{"bunny.ply", 34834, 69451, 0, 0, 223, 0}, Row{"teapot.ply", 3241, 6320, 0, 0, 160, 0},
        Row{"bad_beetle.ply", 1148, 2053, 0, 0, 296, 47}, Row{"bad_legocar.ply", 5915, 10992, 112, 0, 0, 0},
        Row{"bad_cycloidal.ply", 21384, 43368, 0, 0, 0, 242}, Row{"bad_thingi_112932.ply", 3932, 7880, 0, 0, 0, 0},
        Row{"bad_thingi_1514499.ply", 13350, 26700, 0, 0, 0, 0}}) {
    const std::string path = std::string(KD_SOURCE_DIR) + "/../shared/data/" + row.file;
    if (!std::filesystem::exists(path)) {
      MESSAGE("skipped: no " << path);
      continue;
    }
    CAPTURE(path);
    auto mesh = read_mesh(path, {});
    REQUIRE(mesh);
    CHECK(mesh->triangles.size() == row.triangles);
    const Topology t = topology(*mesh);
    CHECK(t.vertices == row.vertices);
    CHECK(t.boundary_edges == row.boundary_edges);
    CHECK(t.non_manifold_edges == row.non_manifold_edges);
    const CleanReport report = clean(*mesh);
    CHECK(report.non_finite.count == 0);
    CHECK(report.degenerate.count == row.degenerate);
    CHECK(report.duplicate.count + report.opposite.count == row.repeated);
    CHECK(mesh->triangles.size() == row.triangles - report.degenerate.count - report.duplicate.count);
  }
}
