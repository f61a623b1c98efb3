// Tracing rays against one object on the device, timed by its own events.
#include <algorithm>

#include "render/cuda/cuda_backend.h"
#include "render/cuda/device_object.h"
#include "render/cuda/warp_trace.h"
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

/// As many blocks as the device holds at once, each warp taking rays until there are none. *taken is 0 before.
template <RayMode mode, TriangleLayout layout>
__global__ void __launch_bounds__(kBlock, kWarpTraceBlocks)
    warp_trace_kernel(const __grid_constant__ TraceView view, const RayRecord* records, uint32_t count, uint32_t* taken,
                      HitRecord* hits) {
  __shared__ WarpRays rays[kBlock / kLanes];
  __shared__ volatile bool none_left;
  if (threadIdx.x == 0) none_left = false;
  __syncthreads();
  detail::StackEntry stack[kMaxDepth];
  WarpTrace<mode, layout>(view, rays[threadIdx.x / kLanes], stack, none_left).run(records, count, taken, hits);
}

/// How many blocks of warp_trace_kernel the device holds at once. No more shared memory is set aside than they take:
/// the rest is cache, and scattered rays want it.
template <class Kernel>
cudaError_t count_blocks(Kernel* kernel, int device, unsigned& blocks) {
  const auto ask = [&](cudaDeviceAttr which) {
    int value = 0;
    cudaDeviceGetAttribute(&value, which, device);
    return value;
  };
  constexpr int kBlocks = kWarpTraceBlocks, kShared = kBlock / kLanes * sizeof(WarpRays);
  const int all = std::max(ask(cudaDevAttrMaxSharedMemoryPerMultiprocessor), 1);
  const int percent = (100 * kBlocks * (kShared + ask(cudaDevAttrReservedSharedMemoryPerBlock)) + all - 1) / all;
  if (const cudaError_t status =
          cudaFuncSetAttribute(kernel, cudaFuncAttributePreferredSharedMemoryCarveout, std::min(percent, 100)))
    return status;
  int at_once = 0;
  const cudaError_t status = cudaOccupancyMaxActiveBlocksPerMultiprocessor(&at_once, kernel, kBlock, 0);
  blocks = static_cast<unsigned>(std::min(at_once, kBlocks) * ask(cudaDevAttrMultiProcessorCount));
  return status;
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
  uint32_t* taken = nullptr;
  const auto lay_out = [&] {
    memory.section("object");
    pieces = object_pieces(memory, geometry, job.layout);
    source_primitives = memory.piece<uint32_t>(sources->size());
    memory.section("rays and hits");
    rays = memory.piece<RayRecord>(job.rays.size());
    hits = memory.piece<HitRecord>(job.rays.size());
    taken = memory.piece<uint32_t>(1);
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
  const bool by_warps =
      job.scattered && job.test == TriangleTest::exact && geometry.triangle_count() <= WarpRays::kNoHit;
  unsigned blocks_at_once = 0;
  if (by_warps) {
    cudaError_t status = cudaSuccess;
    with_mode_and_layout(job, [&]<RayMode mode, TriangleLayout layout>() {
      status = count_blocks(warp_trace_kernel<mode, layout>, index, blocks_at_once);
    });
    KD_CUDA_TRY(status, "preparing to trace");
  }
  const auto launch = [&] {
    if (count == 0) return;
    if (by_warps) {
      cudaMemsetAsync(taken, 0, sizeof *taken, stream);
      with_mode_and_layout(job, [&]<RayMode mode, TriangleLayout layout>() {
        warp_trace_kernel<mode, layout><<<blocks_at_once, kBlock, 0, stream>>>(view, rays, count, taken, hits);
      });
      return;
    }
    with_test(job.test, [&]<class Test>() {
      with_mode_and_layout(job, [&]<RayMode mode, TriangleLayout layout>() {
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
