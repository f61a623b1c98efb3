// Tracing rays against one object: expansion, and hits as traversal finds them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>

#include "ray_records.h"
#include "render/cpu_backend.h"
#include "render/expand.h"
#include "worlds.h"

using namespace kd;
using namespace kd::test;

TEST_CASE("trace: vertices expand to what was packed, at every width") {
  for (const int bits : {1, 6, 10, 11, 16, 21, 22, 24}) {
    const Shape shape = soup_shape(bits, 60, Soup::mixed, 1);
    const Contents c(shape, bits, false);
    const std::vector<TriangleVertices> expected = expanded(shape);
    for (size_t i = 0; i < expected.size(); ++i) {
      TriangleVertices t;
      c.geometry().packed().expand(i, t);
      REQUIRE(t.a == expected[i].a);
      REQUIRE(t.b == expected[i].b);
      REQUIRE(t.c == expected[i].c);
    }
  }
}

TEST_CASE("trace: the compact layout gives the same triangles, at every width") {
  for (const int bits : {1, 6, 10, 16, 20, 21, 22, 24}) {
    CAPTURE(bits);
    const Shape shape = soup_shape(bits, 60, Soup::mixed, 1);
    const Contents c(shape, bits, false);
    const std::vector<TriangleVertices> expected = expanded(shape);
    const render::HostObject compact(c.geometry(), TriangleLayout::compact);
    const ObjectView view = compact.view();
    REQUIRE(view.triangles == nullptr);
    CHECK(view.compact.narrow == (bits <= 21));
    for (size_t i = 0; i < expected.size(); ++i) {
      const TriangleVertices t = view.triangle(i);
      REQUIRE(t.a == expected[i].a);
      REQUIRE(t.b == expected[i].b);
      REQUIRE(t.c == expected[i].c);
    }
  }
}

TEST_CASE("trace: hits are those of looking at every triangle, numbered as in the source") {
  const TempFolder folder;
  for (const int bits : {10, 21, 24}) {
    CAPTURE(bits);
    const Shape shape = soup_shape(bits, 200, Soup::mixed, 1);
    const Contents c(shape, bits);  // triangle i is primitive 3 i + 1
    const auto file = nkd::ObjectFile::open(c.write(folder.file("a.nkd")));
    REQUIRE(file);
    const std::vector<TriangleVertices> triangles = expanded(shape);
    const std::vector<render::RayRecord> rays = adversarial_records(shape, cube_lattice(bits), 3000, 2);
    render::TraceJob job{rays, RayMode::closest, 1, 2, true};
    const auto closest = render::cpu_trace(*file, job, 0);
    job.mode = RayMode::any;
    const auto any = render::cpu_trace(*file, job, 0);
    REQUIRE(closest);
    REQUIRE(any);
    REQUIRE(closest->hits.size() == rays.size());
    job.layout = TriangleLayout::compact;
    job.mode = RayMode::closest;
    const auto compact = render::cpu_trace(*file, job, 0);
    REQUIRE(compact);
    CHECK(std::memcmp(compact->hits.data(), closest->hits.data(), rays.size() * sizeof(render::HitRecord)) == 0);
    job.packets = false;
    const auto singly = render::cpu_trace(*file, job, 0);
    REQUIRE(singly);
    CHECK(std::memcmp(singly->hits.data(), closest->hits.data(), rays.size() * sizeof(render::HitRecord)) == 0);
    // A soup shares no vertices: what is twice as long beyond 21 bits takes more than it saves.
    CHECK((compact->device_bytes < closest->device_bytes) == (bits <= 21));
    CHECK(closest->seconds.size() == 2);
    CHECK(closest->steps.triangles > 0);
    CHECK(any->steps.triangles <= closest->steps.triangles);
    int wrong = 0, met = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      const render::RayRecord& r = rays[i];
      const render::HitRecord& hit = closest->hits[i];
      LatticeRay ray;
      uint32_t expected = kNoTriangle;
      TriangleHit at{};
      if (snap_ray({r.ox, r.oy, r.oz}, {r.dx, r.dy, r.dz}, 0, r.t_max, bits, ray)) {
        expected = brute_force(triangles, ray, 1e30f, kNoTriangle);
        if (expected != kNoTriangle) intersect_triangle(ray, triangles[expected], at);
      }
      wrong += (any->hits[i].primitive < 0) != (expected == kNoTriangle);
      if (expected == kNoTriangle) {
        wrong += hit.primitive != -1 || hit.t != r.t_max || hit.u != 0 || hit.v != 0;
        continue;
      }
      ++met;
      wrong += hit.primitive != static_cast<int32_t>(3 * expected + 1);
      wrong += hit.t != static_cast<float>(ray.t_at(at.s));
      wrong += hit.u != static_cast<float>(at.u) || hit.v != static_cast<float>(at.v);
    }
    CHECK(wrong == 0);
    CHECK(met > 500);
  }
}

TEST_CASE("trace: t is the same number in model space, whatever the lattice") {
  const TempFolder folder;
  Contents c = unit_cube();
  c.summary.lattice = {{10, -20, 30}, {2, 4, 8}, 21};
  c.count_tree();
  const auto file = nkd::ObjectFile::open(c.write(folder.file("a.nkd")));
  REQUIRE(file);
  const std::vector<render::RayRecord> rays{{0, -18, 34, 0, 4, 0, 0, 1e30f},  {11, -18, 48, 0, 0, 0, -0.5f, 1e30f},
                                            {11, -18, 34, 0, 0, 1, 0, 1e30f}, {11, -18, 34, 0, 0, 1, 0, 1.5f},
                                            {0, -18, 34, 0, -1, 0, 0, 1e30f}, {0, -18, 34, 2.75f, 4, 0, 0, 1e30f}};
  const auto traced = render::cpu_trace(*file, {rays, RayMode::closest, 0, 1, false}, 0);
  REQUIRE(traced);
  CHECK(traced->hits[0].t == doctest::Approx(2.5).epsilon(1e-6));
  CHECK(traced->hits[1].t == doctest::Approx(20).epsilon(1e-6));
  CHECK(traced->hits[2].t == doctest::Approx(2).epsilon(1e-6));
  CHECK(traced->hits[3].primitive == -1);
  CHECK(traced->hits[3].t == 1.5f);
  CHECK(traced->hits[4].primitive == -1);
  CHECK(traced->hits[5].t == doctest::Approx(3).epsilon(1e-6));
}
