// A stage as a kernel: a thread a pixel.
#pragma once

#include "render/cuda/cuda.h"
#include "render/pipeline.h"

namespace kd::render {

/// Pixel of a thread: a warp covers a tile of 8 x 4 pixels, so that its rays stay together.
__device__ inline uint32_t tiled_pixel(uint32_t thread, uint32_t width, uint32_t height) {
  const uint32_t tiles_across = (width + 7) / 8;
  const uint32_t tile = thread / 32, lane = thread % 32;
  const uint32_t x = tile % tiles_across * 8 + lane % 8, y = tile / tiles_across * 4 + lane / 8;
  return x < width && y < height ? y * width + x : kNone;
}

/// The same for a stage: those that trace. With a hierarchy shadow rays gain 13 to 17 % by it.
template <class Stage>
constexpr unsigned kStageBlocks = 1;
template <class Instances>
constexpr unsigned kStageBlocks<ObjectIntersection<Instances>> = kTraceBlocks;
template <class Instances>
constexpr unsigned kStageBlocks<Lighting<Instances>> = kTraceBlocks;

/// Where a stage that counts something adds it up.
struct Tally {
  unsigned long long* total = nullptr;  // on the device
  uint32_t* raised = nullptr;           // a HostFlag's, raised by some that add to it; null: nobody waits
};

/// Blocks of which one raises a flag: that is a write to the host, and tens of thousands would take their time. So
/// would asking the total whether it was 0, once for all: as warps wait for the answer, the frame takes 1.5 % longer.
constexpr unsigned kRaisingBlock = 16;

template <class Stage>
__global__ void __launch_bounds__(kBlock, kStageBlocks<Stage>) stage_kernel(Stage stage, Tally tally) {
  const uint32_t pixel = tiled_pixel(blockIdx.x * blockDim.x + threadIdx.x, stage.frame.width, stage.frame.height);
  const bool counted = pixel != kNone && stage(pixel) != 0;
  if constexpr (kCounter<Stage> != kCounters) {
    const unsigned lanes = __ballot_sync(~0u, counted);
    if (threadIdx.x % 32 == 0 && lanes != 0) {
      atomicAdd(tally.total, static_cast<unsigned long long>(__popc(lanes)));
      if (tally.raised != nullptr && blockIdx.x % kRaisingBlock == 0)
        *static_cast<volatile uint32_t*>(tally.raised) = 1;
    }
  }
}

/// Runs stage(pixel) for every pixel of its strip.
template <class Stage>
cudaError_t launch_stage(const Stage& stage, const Tally& tally, cudaStream_t stream) {
  const size_t tiles = size_t{(stage.frame.width + 7) / 8} * ((stage.frame.height + 3) / 4);
  stage_kernel<<<blocks_for(tiles * 32), kBlock, 0, stream>>>(stage, tally);
  return cudaGetLastError();
}

}  // namespace kd::render
