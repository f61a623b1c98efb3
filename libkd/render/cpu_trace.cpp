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
  PacketQuery query;
  RaySet entering = kNoRays;
  for (size_t i = 0; i < rays.size(); ++i) {
    hits[i] = miss_of(rays[i]);
    if (!enter_object<Test>(view, rays[i], query.rays[i])) continue;
    query.s_limit[i] = query.rays[i].s_max;
    query.excluded[i] = kNoTriangle;
    entering |= set_of(i);
  }
  PerRay<uint32_t> met;
  traverse<mode, Test, layout>(view.object, query, entering, met);
  for_each_ray(entering, [&](size_t i) {
    if (met[i] != kNoTriangle) hits[i] = hit_on<Test, layout>(view, query.rays[i], met[i]);
  });
}

template <RayMode mode, class Test, TriangleLayout layout>
void trace_all(const TraceView& view, const TraceJob& job, TraceOutcome& out) {
  const auto pass = [&] {
    parallel_ranges(job.rays.size(), 256, [&](size_t begin, size_t end) {
      if constexpr (Test::kExact) {
        for (size_t i = begin; i < end; i += kPacketRays) {
          const auto rays = job.rays.subspan(i, std::min(kPacketRays, end - i));
          trace_packet<mode, Test, layout>(view, rays, out.hits.data() + i);
        }
      } else {
        NoCounter counter;
        for (size_t i = begin; i < end; ++i) out.hits[i] = trace_ray<mode, Test, layout>(view, job.rays[i], counter);
      }
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
  with_kernel(job, [&]<RayMode mode, class Test>() {
    with_layout(job.layout, [&]<TriangleLayout layout>() { trace_all<mode, Test, layout>(view, job, out); });
  });
  return out;
}

}  // namespace kd::render
