// Tracing rays against one object on the CPU. In a file of its own because compilers inline less the more a file holds:
// beside these six kernels a render took 2 % more instructions.
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

template <RayMode mode, class Test, TriangleLayout layout>
void trace_all(const TraceView& view, const TraceJob& job, TraceOutcome& out) {
  const auto pass = [&] {
    parallel_ranges(job.rays.size(), 256, [&](size_t begin, size_t end) {
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
  with_kernel(job, [&]<RayMode mode, class Test>() {
    with_layout(job.layout, [&]<TriangleLayout layout>() { trace_all<mode, Test, layout>(view, job, out); });
  });
  return out;
}

}  // namespace kd::render
