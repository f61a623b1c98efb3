// Tracing rays against one object on the CPU. In a file of its own because compilers inline less the more a file holds:
// beside these six kernels a render took 2 % more instructions.
#include <algorithm>

#include "core/packet_traversal.h"
#include "render/cpu_backend.h"
#include "render/expand.h"
#include "sys/parallel.h"
#include "sys/timer.h"

namespace kd::render {

namespace {

struct StepCounter {
  StepCounts counts;
  void node() { ++counts.nodes; }
  void leaf() { ++counts.leaves; }
  void triangle() { ++counts.triangles; }
  void evaluated_in_double() {}
};

/// hits[i] of rays[i], of a packet.
template <RayMode mode, class Test, TriangleLayout layout>
void trace_packet(const TraceView& view, std::span<const RayRecord> rays, HitRecord* hits) {
  const RaySet set = first_rays(rays.size());
  PerRay<Ray> each;
  for_each_ray(set, [&](size_t i) {
    const RayRecord& r = rays[i];
    each[i] = {{r.ox, r.oy, r.oz}, {r.dx, r.dy, r.dz}, r.t_min, r.t_max};
    hits[i] = miss_of(r);
  });
  const BasicRay<PacketDoubles> packet = packed(each, set);
  PacketQuery query;
  const RaySet entering =
      set & snap_ray(view.to_lattice.apply_point(packet.origin), view.to_lattice.apply_vector(packet.direction),
                     packet.t_min, packet.t_max, view.object.bits, query.rays)
                .rays();
  query.s_limit = query.rays.s_max;
  query.excluded.fill(kNoTriangle);
  PacketAnswer answer;
  traverse<mode, Test, layout>(view.object, query, entering, answer);
  for_each_ray(entering, [&](size_t i) {
    const uint32_t triangle = answer.met[i];
    if (triangle == kNoTriangle) return;
    const LatticeRay ray = ray_of(query.rays, i);
    const bool located = mode == RayMode::closest;
    const TriangleHit hit = located ? answer.hits[i] : Test(ray).locate(view.object.triangle<layout>(triangle));
    hits[i] = record_of(view, ray, triangle, hit);
  });
}

template <RayMode mode, class Test, TriangleLayout layout>
void trace_all(const TraceView& view, const TraceJob& job, TraceOutcome& out) {
  const auto pass = [&] {
    parallel_ranges(job.rays.size(), 256, [&](size_t begin, size_t end) {
      if constexpr (Test::kExact) {
        if (job.packets) {
          for (size_t i = begin; i < end; i += kPacketRays) {
            const auto rays = job.rays.subspan(i, std::min(kPacketRays, end - i));
            trace_packet<mode, Test, layout>(view, rays, out.hits.data() + i);
          }
          return;
        }
      }
      NoCounter counter;
      for (size_t i = begin; i < end; ++i) out.hits[i] = trace_ray<mode, Test, layout>(view, job.rays[i], counter);
    });
  };
  for (int i = 0; i < job.warm_ups; ++i) pass();
  for (int i = 0; i < job.repeats; ++i) {
    Timer timer;
    pass();
    out.seconds.push_back(timer.seconds());
  }
  if (!job.count_steps) return;
  StepCounter counter;
  for (const RayRecord& ray : job.rays) trace_ray<mode, Test, layout>(view, ray, counter);
  out.steps = counter.counts;
}

}  // namespace

Result<TraceOutcome> cpu_trace(const nkd::ObjectFile& object, const TraceJob& job, int) {
  auto sources = object.source_primitives();
  if (!sources) return sources.error();
  const nkd::Geometry& geometry = object.geometry();
  const Lattice& lattice = object.summary().lattice;
  const HostObject ready(geometry, job.layout);
  const TraceView view{ready.view(), invert(lattice.frame()), sources->empty() ? nullptr : sources->data()};
  TraceOutcome out;
  out.hits.resize(job.rays.size());
  out.device_bytes = traversal_bytes(geometry, job.layout);
  with_test(job.test, [&]<class Test>() {
    with_mode_and_layout(job,
                         [&]<RayMode mode, TriangleLayout layout>() { trace_all<mode, Test, layout>(view, job, out); });
  });
  return out;
}

}  // namespace kd::render
