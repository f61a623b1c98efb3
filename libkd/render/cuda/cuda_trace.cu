// Tracing rays against one object on the device, timed by its own events.
#include "render/cuda/cuda_backend.h"
#include "render/cuda/device_object.h"
#include "render/expand.h"

namespace kd::render {

namespace {

template <RayMode mode, class Test, TriangleLayout layout>
__global__ void __launch_bounds__(kBlock, kTraceBlocks)
    trace_kernel(TraceView view, const RayRecord* rays, uint32_t count, HitRecord* hits) {
  const uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= count) return;
  NoCounter counter;
  hits[i] = trace_ray<mode, Test, layout>(view, load(rays + i), counter);
}

}  // namespace

Result<TraceOutcome> cuda_trace(const nkd::ObjectFile& object, const TraceJob& job, int index) {
  auto sources = object.source_primitives();
  if (!sources) return sources.error();
  const nkd::Geometry& geometry = object.geometry();
  const Lattice& lattice = object.summary().lattice;
  KD_CUDA_TRY(cudaSetDevice(index), "choosing the device");
  Stream stream;
  KD_CUDA_TRY(stream.create(), "starting");

  DeviceMemory memory;
  DeviceObject pieces{};
  Staging staging;
  uint32_t* source_primitives = nullptr;
  RayRecord* rays = nullptr;
  HitRecord* hits = nullptr;
  const auto lay_out = [&] {
    memory.section("object");
    pieces = object_pieces(memory, geometry, job.layout);
    source_primitives = memory.piece<uint32_t>(sources->size());
    memory.section("rays and hits");
    rays = memory.piece<RayRecord>(job.rays.size());
    hits = memory.piece<HitRecord>(job.rays.size());
  };
  lay_out();
  if (auto allocated = memory.allocate(); !allocated) return allocated.error();
  lay_out();
  staging.include(geometry);
  if (auto allocated = staging.allocate(); !allocated) return allocated.error();
  KD_CUDA_TRY(fill_object(pieces, staging, geometry, stream), "uploading the object");
  KD_CUDA_TRY(upload(source_primitives, *sources, stream), "uploading the object");
  KD_CUDA_TRY(upload(rays, job.rays, stream), "uploading the rays");

  const TraceView view{pieces.view(lattice.bits), invert(lattice.frame()), source_primitives};
  const auto count = static_cast<uint32_t>(job.rays.size());
  const auto launch = [&] {
    if (count == 0) return;
    with_kernel(job, [&]<RayMode mode, class Test>() {
      with_layout(job.layout, [&]<TriangleLayout layout>() {
        trace_kernel<mode, Test, layout><<<blocks_for(count), kBlock, 0, stream>>>(view, rays, count, hits);
      });
    });
  };
  TraceOutcome out;
  Event start, end;
  for (int i = 0; i < job.warm_ups; ++i) launch();
  for (int i = 0; i < job.repeats; ++i) {
    start.record(stream);
    launch();
    end.record(stream);
    KD_CUDA_TRY(cudaStreamSynchronize(stream), "tracing");
    out.seconds.push_back(end.seconds_since(start));
  }
  KD_CUDA_TRY(cudaGetLastError(), "tracing");
  out.hits.resize(count);
  KD_CUDA_TRY(download(out.hits.data(), hits, count, stream), "copying the hits back");
  KD_CUDA_TRY(cudaStreamSynchronize(stream), "copying the hits back");
  out.device_bytes = traversal_bytes(geometry, job.layout);
  return out;
}

}  // namespace kd::render
