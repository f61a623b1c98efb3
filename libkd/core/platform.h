// The one header that names a compiler. Everything in core/ compiles under g++, clang++ and nvcc alike, with
// contraction off (-ffp-contract=off, -fmad=false): a fused multiply-add happens where `fma` is written and
// nowhere else, so a CPU and a GPU that run the same function return the same bits.
#pragma once

#if defined(__CUDACC__)
#define KD_HD __host__ __device__
#define KD_INLINE __forceinline__
#else
#define KD_HD
#define KD_INLINE inline
#endif
