// Tracing rays against one object, without a scene: what benchmarks and comparisons with other tracers use.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/float_triangle.h"
#include "core/frame.h"
#include "core/traversal.h"
#include "render/float_ray.h"

namespace kd::render {

/// A ray in model space as RAYS.bin has it: 32 bytes, little-endian.
struct alignas(16) RayRecord {
  float ox, oy, oz, t_min, dx, dy, dz, t_max;
};
static_assert(sizeof(RayRecord) == 32);

/// A hit as HITS.bin has it: 16 bytes. A miss has primitive -1 and the ray's t_max; with RayMode::any it is some hit.
struct alignas(16) HitRecord {
  float t;
  int32_t primitive;  // the triangle's number in the source mesh
  float u, v;
};
static_assert(sizeof(HitRecord) == 16);

/// An object ready for tracing.
struct TraceView {
  ObjectView object;
  InverseFrame to_lattice;                      // from model space
  const uint32_t* source_primitives = nullptr;  // null: triangle i is primitive i
};

/// Which triangle test the kernel runs. All but the exact one are baselines, and take a ray that is not snapped.
enum class TriangleTest { exact, moller_trumbore, woop };

KD_HD KD_INLINE HitRecord miss_of(const RayRecord& r) { return {r.t_max, -1, 0, 0}; }

/// Of a triangle that the ray meets, and where.
template <class Hit>
KD_HD KD_INLINE HitRecord record_of(const TraceView& view, const LatticeRay& ray, uint32_t triangle, const Hit& hit) {
  const uint32_t source = view.source_primitives ? view.source_primitives[triangle] : triangle;
  return {static_cast<float>(ray.t_at(hit.s)), static_cast<int32_t>(source), static_cast<float>(hit.u),
          static_cast<float>(hit.v)};
}

/// The ray in the object's lattice, snapped for the exact test. False: it misses the cube.
template <bool exact>
KD_HD KD_INLINE bool lattice_ray(const InverseFrame& to_lattice, int bits, const RayRecord& r, LatticeRay& ray) {
  const Vec3d origin = to_lattice.apply_point({r.ox, r.oy, r.oz});
  const Vec3d direction = to_lattice.apply_vector({r.dx, r.dy, r.dz});
  return exact ? snap_ray(origin, direction, r.t_min, r.t_max, bits, ray)
               : float_ray(origin, direction, r.t_min, r.t_max, bits, ray);
}

template <RayMode mode, class Test, TriangleLayout layout, class Counter>
KD_HD inline HitRecord trace_ray(const TraceView& view, const RayRecord& r, Counter& counter) {
  LatticeRay ray;
  if (!lattice_ray<Test::kExact>(view.to_lattice, view.object.bits, r, ray)) return miss_of(r);
  const uint32_t triangle = traverse<mode, Test, layout>(view.object, ray, ray.s_max, kNoTriangle, counter);
  if (triangle == kNoTriangle) return miss_of(r);
  return record_of(view, ray, triangle, Test{ray}.locate(view.object.triangle<layout>(triangle)));
}

struct TraceJob {
  std::span<const RayRecord> rays;
  RayMode mode = RayMode::closest;
  int warm_ups = 3;
  int repeats = 10;                         // >= 1
  bool count_steps = false;                 // CPU only: one more pass that counts
  TriangleTest test = TriangleTest::exact;  // of float32 vertices the exact test is none
  TriangleLayout layout = TriangleLayout::expanded;
  bool packets = true;     // CPU and the exact test only: rays go in packets, as they follow one another; the same hits
  bool scattered = false;  // CUDA and the exact test only: rays have nothing to do with their neighbours; the same hits
};

/// Calls visit.operator()<Test>() for a triangle test.
template <class Visit>
auto with_test(TriangleTest test, Visit&& visit) {
  switch (test) {
    case TriangleTest::moller_trumbore:
      return visit.template operator()<MollerTrumboreTest>();
    case TriangleTest::woop:
      return visit.template operator()<WoopTest>();
    default:
      return visit.template operator()<ExactTest>();
  }
}

/// Calls visit.operator()<mode, layout>() for those of a job.
template <class Visit>
void with_mode_and_layout(const TraceJob& job, Visit&& visit) {
  with_layout(job.layout, [&]<TriangleLayout layout>() {
    if (job.mode == RayMode::closest) {
      visit.template operator()<RayMode::closest, layout>();
    } else {
      visit.template operator()<RayMode::any, layout>();
    }
  });
}

struct StepCounts {
  uint64_t nodes = 0;
  uint64_t leaves = 0;
  uint64_t triangles = 0;
};

struct TraceOutcome {
  std::vector<HitRecord> hits;  // one a ray
  std::vector<double> seconds;  // one a repeat: the kernel, or the parallel loop
  uint64_t device_bytes = 0;    // of the object: nodes, references, triangles
  StepCounts steps;
};

}  // namespace kd::render
