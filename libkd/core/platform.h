// The one header that names a compiler. Everything in core/ compiles under g++, clang++ and nvcc alike, with
// contraction off (-ffp-contract=off, -fmad=false): a fused multiply-add happens where `fma` is written and
// nowhere else, so a CPU and a GPU that run the same function return the same bits.
#pragma once

#include <cstddef>
#include <cstring>
#include <type_traits>

/// KD_INLINE: for what inner loops call. KD_HOST_INLINE: for what a device's compiler inlines by itself and a host's
/// does not. Left alone, g++ made functions of the triangle test and of snapping, which took longer than what they do:
/// vectors go over the stack, written in pieces and read whole, and no processor forwards that.
#if defined(__CUDACC__)
#define KD_HD __host__ __device__
#define KD_INLINE __forceinline__
#define KD_HOST_INLINE inline
#else
#define KD_HD
#define KD_INLINE [[gnu::always_inline]] inline
#define KD_HOST_INLINE [[gnu::always_inline]] inline
#endif

/// Whether this is the pass that compiles for a device.
#if defined(__CUDA_ARCH__)
#define KD_ON_DEVICE true
#else
#define KD_ON_DEVICE false
#endif

namespace kd {

/// *from, which nothing writes while it is read. A device loads it in as few pieces as its alignment, 8 or 16 bytes,
/// allows: left to itself the compiler takes a triangle in nine.
template <class T>
KD_HD KD_INLINE T load(const T* from) {
  static_assert(alignof(T) == 8 || alignof(T) == 16);
#if defined(__CUDA_ARCH__)
  using Piece = std::conditional_t<alignof(T) == 16, uint4, uint2>;
  constexpr size_t kPieces = sizeof(T) / sizeof(Piece);
  Piece pieces[kPieces];
  for (size_t i = 0; i < kPieces; ++i) pieces[i] = __ldg(reinterpret_cast<const Piece*>(from) + i);
  T value;
  memcpy(&value, pieces, sizeof value);
  return value;
#else
  return *from;
#endif
}

}  // namespace kd
