#include <algorithm>
#include <array>
#include <optional>

#include "floor/rates.h"
#include "render/cuda/device_memory.h"

namespace kd::bench::floors {

namespace {

using render::Event;
using render::Stream;

constexpr unsigned kThreads = 256;         // a block
constexpr unsigned kBlocksAProcessor = 8;  // all the threads that a multiprocessor holds
constexpr int kChains = 8;                 // independent of each other, so that latency is hidden
constexpr uint32_t kRounds = 8192;
constexpr uint32_t kLoadRounds = 512;
constexpr int kRepeats = 5;

// Each takes one step in all chains; kInstructions says of how many instructions (SASS: no more and no fewer). What one
// chain takes from its neighbour keeps the compiler from doing several steps at once.
struct Fma {
  static constexpr double kInstructions = kChains;
  float v[kChains];
  __device__ void start(float x) {
    for (int k = 0; k < kChains; ++k) v[k] = x + k;
  }
  __device__ void step(float a) {
#pragma unroll
    for (int k = 0; k < kChains; ++k) v[k] = fmaf(v[k], a, v[(k + 1) % kChains]);
  }
  __device__ float sum() const {
    float s = 0;
    for (int k = 0; k < kChains; ++k) s += v[k];
    return s;
  }
};

struct Logic {
  static constexpr double kInstructions = kChains;
  uint32_t v[kChains];
  __device__ void start(float x) {
    for (int k = 0; k < kChains; ++k) v[k] = __float_as_uint(x) + k;
  }
  __device__ void step(float a) {
#pragma unroll
    for (int k = 0; k < kChains; ++k) v[k] = (v[k] & v[(k + 1) % kChains]) ^ __float_as_uint(a);
  }
  __device__ float sum() const {
    uint32_t s = 0;
    for (int k = 0; k < kChains; ++k) s += v[k];
    return __uint_as_float(s);
  }
};

struct MinMax {
  static constexpr double kInstructions = 2 * kChains;
  float v[kChains];
  __device__ void start(float x) {
    for (int k = 0; k < kChains; ++k) v[k] = x * k;
  }
  __device__ void step(float a) {
#pragma unroll
    for (int k = 0; k < kChains; ++k) v[k] = fminf(fmaxf(v[k], v[(k + 1) % kChains]), a);
  }
  __device__ float sum() const {
    float s = 0;
    for (int k = 0; k < kChains; ++k) s += v[k];
    return s;
  }
};

struct Mixed {
  static constexpr double kInstructions = 2 * Fma::kInstructions + Logic::kInstructions;
  Fma first, second;
  Logic logic;
  __device__ void start(float x) {
    first.start(x);
    second.start(x + 1);
    logic.start(x);
  }
  __device__ void step(float a) {
    first.step(a);
    second.step(a);
    logic.step(a);
  }
  __device__ float sum() const { return first.sum() + second.sum() + logic.sum(); }
};

struct Fp64 {
  static constexpr double kInstructions = kChains;
  double v[kChains];
  __device__ void start(float x) {
    for (int k = 0; k < kChains; ++k) v[k] = x + k;
  }
  __device__ void step(float a) {
    const double factor = a;
#pragma unroll
    for (int k = 0; k < kChains; ++k) v[k] = fma(v[k], factor, v[(k + 1) % kChains]);
  }
  __device__ float sum() const {
    double s = 0;
    for (int k = 0; k < kChains; ++k) s += v[k];
    return static_cast<float>(s);
  }
};

struct Convert {
  static constexpr double kInstructions = 2 * kChains;
  double v[kChains];
  __device__ void start(float x) {
    for (int k = 0; k < kChains; ++k) v[k] = x + k;
  }
  __device__ void step(float) {
#pragma unroll
    for (int k = 0; k < kChains; ++k) {
      float narrow;  // volatile: a conversion there and back would be left out
      asm volatile("cvt.rn.f32.f64 %0, %1;" : "=f"(narrow) : "d"(v[k]));
      asm volatile("cvt.f64.f32 %0, %1;" : "=d"(v[k]) : "f"(narrow));
    }
  }
  __device__ float sum() const {
    double s = 0;
    for (int k = 0; k < kChains; ++k) s += v[k];
    return static_cast<float>(s);
  }
};

/// `sink` is written if a sum is what none is, so that no step can be left out.
template <class Chains>
__global__ void __launch_bounds__(kThreads) instruction_kernel(float a, uint32_t rounds, float* sink) {
  Chains chains;
  chains.start(a * static_cast<float>(blockIdx.x * blockDim.x + threadIdx.x));
#pragma unroll 16
  for (uint32_t i = 0; i < rounds; ++i) chains.step(a);
  if (const float sum = chains.sum(); sum == 12345.678f) *sink = sum;
}

__device__ uint32_t scattered(uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

__device__ uint32_t folded(uint2 v) { return v.x ^ v.y; }
__device__ uint32_t folded(uint4 v) { return v.x ^ v.y ^ v.z ^ v.w; }

/// Every thread by itself, from random places among `count`.
template <class Piece>
__global__ void __launch_bounds__(kThreads)
    load_kernel(const Piece* pieces, uint32_t count, uint32_t rounds, uint32_t* sink) {
  uint32_t place = scattered(blockIdx.x * blockDim.x + threadIdx.x), sum = 0;
#pragma unroll 8
  for (uint32_t i = 0; i < rounds; ++i) {
    place = place * 1664525u + 1013904223u;
    sum ^= folded(__ldg(pieces + __umulhi(place, count)));
  }
  if (sum == 0x12345678u) *sink = sum;
}

__global__ void __launch_bounds__(kThreads) stream_kernel(const uint4* pieces, uint32_t count, uint32_t* sink) {
  uint32_t sum = 0;
#pragma unroll 8
  for (uint32_t i = blockIdx.x * blockDim.x + threadIdx.x; i < count; i += gridDim.x * blockDim.x)
    sum ^= folded(__ldg(pieces + i));
  if (sum == 0x12345678u) *sink = sum;
}

/// A stream to measure on, and a place for what is never written.
class Meter {
 public:
  Result<void> create(int device_index, uint64_t bytes) {
    KD_CUDA_TRY(cudaSetDevice(device_index), "choosing the device");
    KD_CUDA_TRY(stream_.create(), "starting");
    int processors = 0;
    KD_CUDA_TRY(cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device_index), "starting");
    blocks_ = static_cast<unsigned>(processors) * kBlocksAProcessor;
    bytes_ = bytes / sizeof(uint4) * sizeof(uint4);
    const auto lay_out = [&] {
      sink_ = memory_.piece<uint32_t>(1);
      pieces_ = memory_.piece<std::byte>(bytes_);
    };
    lay_out();
    if (auto allocated = memory_.allocate(); !allocated) return allocated.error();
    lay_out();
    if (pieces_) KD_CUDA_TRY(cudaMemsetAsync(pieces_, 1, bytes_, stream_), "starting");
    return {};
  }

  template <class Chains>
  Result<double> instructions() const {
    auto seconds = median_seconds([&] {
      instruction_kernel<Chains><<<blocks_, kThreads, 0, stream_>>>(0.999f, kRounds, reinterpret_cast<float*>(sink_));
    });
    if (!seconds) return seconds;
    return threads() * kRounds * Chains::kInstructions / *seconds;
  }

  /// Over the first `footprint` bytes.
  Result<LoadRates> loads(uint64_t footprint) const {
    auto of_8 = loads_of<uint2>(footprint);
    if (!of_8) return of_8.error();
    auto of_16 = loads_of<uint4>(footprint);
    if (!of_16) return of_16.error();
    return LoadRates{*of_8, *of_16};
  }

  Result<double> streamed() const {
    const auto count = static_cast<uint32_t>(bytes_ / sizeof(uint4));
    auto seconds = median_seconds([&] {
      stream_kernel<<<blocks_, kThreads, 0, stream_>>>(reinterpret_cast<const uint4*>(pieces_), count, sink_);
    });
    if (!seconds) return seconds;
    return static_cast<double>(bytes_) / *seconds;
  }

 private:
  template <class Piece>
  Result<double> loads_of(uint64_t footprint) const {
    const auto count = static_cast<uint32_t>(footprint / sizeof(Piece));
    auto seconds = median_seconds([&] {
      load_kernel<<<blocks_, kThreads, 0, stream_>>>(reinterpret_cast<const Piece*>(pieces_), count, kLoadRounds,
                                                     sink_);
    });
    if (!seconds) return seconds;
    return threads() * kLoadRounds / *seconds;
  }

  double threads() const { return static_cast<double>(blocks_) * kThreads; }

  template <class Launch>
  Result<double> median_seconds(const Launch& launch) const {
    std::array<double, kRepeats> seconds;
    Event start, end;
    launch();
    for (double& s : seconds) {
      start.record(stream_);
      launch();
      end.record(stream_);
      KD_CUDA_TRY(cudaGetLastError(), "measuring the chip");
      KD_CUDA_TRY(cudaStreamSynchronize(stream_), "measuring the chip");
      s = end.seconds_since(start);
    }
    std::sort(seconds.begin(), seconds.end());
    return seconds[kRepeats / 2];
  }

  Stream stream_;
  render::DeviceMemory memory_;
  unsigned blocks_ = 0;
  uint64_t bytes_ = 0;
  std::byte* pieces_ = nullptr;
  uint32_t* sink_ = nullptr;
};

/// Sets `to` from a measurement; keeps the first error.
template <class T>
void take(const Result<T>& measured, T& to, std::optional<Error>& error) {
  if (measured) {
    to = *measured;
  } else if (!error) {
    error = measured.error();
  }
}

}  // namespace

Result<ChipRates> measure_chip(int device_index) {
  Meter meter;
  if (auto created = meter.create(device_index, kDramFootprint); !created) return created.error();
  ChipRates rates;
  InstructionRates& instructions = rates.instructions;
  std::optional<Error> error;
  take(meter.instructions<Mixed>(), instructions.issue, error);
  take(meter.instructions<Fma>(), instructions.fma, error);
  take(meter.instructions<Logic>(), instructions.logic, error);
  take(meter.instructions<MinMax>(), instructions.min_max, error);
  take(meter.instructions<Fp64>(), instructions.fp64, error);
  take(meter.instructions<Convert>(), instructions.convert, error);
  take(meter.loads(kL1Footprint), rates.l1, error);
  take(meter.loads(kDramFootprint), rates.dram, error);
  take(meter.streamed(), rates.streamed, error);
  if (error) return *error;
  return rates;
}

Result<LoadRates> measure_loads(int device_index, uint64_t footprint_bytes) {
  Meter meter;
  if (auto created = meter.create(device_index, footprint_bytes); !created) return created.error();
  return meter.loads(footprint_bytes);
}

}  // namespace kd::bench::floors
