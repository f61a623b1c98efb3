// Rays that a GPU's warps work on together meet what each of them meets alone on the CPU, to the bit.
#include <cstring>

#include <doctest/doctest.h>

#include "../render/ray_records.h"
#include "support/workshop.h"

using namespace kd;
using namespace kd::test;

namespace {

Shape shape_of(const nkd::Geometry& geometry) {
  const PackedTriangles packed = geometry.packed();
  Shape shape;
  for (size_t i = 0; i < geometry.vertex_count(); ++i) shape.vertices.push_back(packed.lattice_point(i));
  for (size_t i = 0; i < geometry.triangle_count(); ++i) {
    const Vec3u c = packed.corners[i];
    shape.triangles.push_back({c.x, c.y, c.z});
  }
  return shape;
}

}  // namespace

TEST_CASE("scattered rays on CUDA meet what they meet on the CPU") {
  const auto cuda = render::choose_device("cuda");
  if (!cuda) {
    MESSAGE("skipped: " << cuda.error().line());
    return;
  }
  const auto cpu = render::choose_device("cpu");
  REQUIRE(cpu);
  Workshop workshop;
  for (const std::string name : kRealMeshes) {
    const auto mesh = shared_mesh(name + ".ply");
    if (!mesh) {
      MESSAGE("skipped: no " << name << " in " << shared_data().string());
      continue;
    }
    CAPTURE(name);
    const auto object = nkd::ObjectFile::open(workshop.compile(*mesh));
    REQUIRE(object);
    const std::vector<render::RayRecord> all =
        adversarial_records(shape_of(object->geometry()), object->summary().lattice, 200000, 7);
    for (const size_t count : {size_t{1}, size_t{33}, all.size()}) {
      render::TraceJob job;
      job.rays = std::span(all).first(count);
      job.warm_ups = 0;
      job.packets = false;  // each ray alone
      job.repeats = 2;      // the second takes its rays anew
      for (const RayMode mode : {RayMode::closest, RayMode::any}) {
        job.mode = mode;
        job.scattered = false;
        const auto expected = cpu->backend->trace(*object, job, cpu->index);
        REQUIRE(expected);
        job.scattered = true;
        for (const TriangleLayout layout : {TriangleLayout::expanded, TriangleLayout::compact}) {
          job.layout = layout;
          const auto got = cuda->backend->trace(*object, job, cuda->index);
          REQUIRE(got);
          REQUIRE(got->hits.size() == count);
          size_t wrong = 0, met = 0;
          for (size_t i = 0; i < count; ++i) {
            const render::HitRecord &a = expected->hits[i], &b = got->hits[i];
            met += a.primitive >= 0;
            wrong += mode == RayMode::any ? (a.primitive < 0) != (b.primitive < 0) : std::memcmp(&a, &b, sizeof a) != 0;
          }
          CHECK(wrong == 0);
          if (count == all.size()) CHECK(met > count / 20);
        }
        job.layout = TriangleLayout::expanded;
      }
    }
    MESSAGE(name << ": the same, " << all.size() << " rays");
  }
}
