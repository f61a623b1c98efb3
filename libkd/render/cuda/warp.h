// What the lanes of a warp do together. Where it is not said otherwise, all 32 take part in it; only sync() orders what
// they write and read.
// Without nvcc they are declared and no more: a test has lanes of its own (tests/render/warp_emulation.h), so that what
// warps do is tested where there is no GPU.
#pragma once

#include <cstdint>

#include "core/platform.h"

#if defined(__CUDACC__)
#define KD_WARP __device__ __forceinline__
#define KD_UNROLL _Pragma("unroll")
#else
#define KD_WARP inline
#define KD_UNROLL
#endif

namespace kd::render::warp {

constexpr uint32_t kLanes = 32;
constexpr unsigned kAll = 0xffffffffu;

#if defined(__CUDACC__)

/// Which lane this is.
KD_WARP uint32_t lane() { return threadIdx.x % kLanes; }
/// What lanes wrote to memory before, all of them see after.
KD_WARP void sync() { __syncwarp(); }
/// The lanes where it is true.
KD_WARP unsigned ballot(bool value) { return __ballot_sync(kAll, value); }
KD_WARP unsigned or_of_all(unsigned bits) {
#if __CUDA_ARCH__ >= 800
  return __reduce_or_sync(kAll, bits);
#else
  for (uint32_t distance = 1; distance < kLanes; distance *= 2) bits |= __shfl_xor_sync(kAll, bits, distance);
  return bits;
#endif
}
/// The value of another lane; of the one `distance` below, or one's own where there is none.
template <class T>
KD_WARP T of_lane(T value, uint32_t from) {
  return __shfl_sync(kAll, value, static_cast<int>(from));
}
KD_WARP uint32_t of_lane_below(uint32_t value, uint32_t distance) { return __shfl_up_sync(kAll, value, distance); }
/// For the lanes of a set alone: those of them that have the same value.
KD_WARP unsigned same_among(unsigned lanes, uint32_t value) { return __match_any_sync(lanes, value); }

/// For a single lane: adds to a counter that all warps share; its value before.
KD_WARP uint32_t add(uint32_t* counter, uint32_t value) { return atomicAdd(counter, value); }

/// For each lane alone, as what follows: an address in shared memory, kept in one register: left to itself the compiler
/// computes it anew for each use.
KD_WARP uint32_t shared_address(const void* at) {
  auto address = static_cast<uint32_t>(__cvta_generic_to_shared(at));
  asm volatile("" : "+r"(address));
  return address;
}
/// How far it is from what is at `base`.
KD_WARP uint32_t distance(uint32_t address, const void* base) {
  return address - static_cast<uint32_t>(__cvta_generic_to_shared(base));
}
/// The two floats there.
KD_WARP void load_shared(uint32_t address, float& a, float& b) {
  asm volatile("ld.shared.v2.f32 {%0, %1}, [%2];" : "=f"(a), "=f"(b) : "r"(address));
}

/// Of a set of lanes, for each lane alone: how many they are.
KD_WARP uint32_t count(unsigned lanes) { return static_cast<uint32_t>(__popc(lanes)); }
/// The lane in which `n` lanes of a set come before.
KD_WARP uint32_t nth(unsigned lanes, uint32_t n) { return __fns(lanes, 0, static_cast<int>(n) + 1); }

#else

uint32_t lane();
void sync();
unsigned ballot(bool value);
unsigned or_of_all(unsigned bits);
template <class T>
T of_lane(T value, uint32_t from);
uint32_t of_lane_below(uint32_t value, uint32_t distance);
unsigned same_among(unsigned lanes, uint32_t value);
uint32_t add(uint32_t* counter, uint32_t value);
uint32_t shared_address(const void* at);
uint32_t distance(uint32_t address, const void* base);
void load_shared(uint32_t address, float& a, float& b);
uint32_t count(unsigned lanes);
uint32_t nth(unsigned lanes, uint32_t n);

#endif

/// The lanes before this one.
KD_WARP unsigned before() { return (1u << lane()) - 1; }

}  // namespace kd::render::warp
