// The numbers of a packet of eight rays, in registers: what core/ computes with where it takes a packet in place of a
// ray. For host code.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#if defined(__AVX2__) && defined(__FMA__)
#include <immintrin.h>
#endif

#include "core/lanes.h"
#include "core/platform.h"

namespace kd {

constexpr size_t kPacketRays = kLanes;

/// A set of a packet's rays: bit i is ray i.
using RaySet = uint32_t;
constexpr RaySet kNoRays = 0;

KD_INLINE size_t first_of(RaySet set) { return static_cast<size_t>(std::countr_zero(set)); }
KD_INLINE RaySet set_of(size_t ray) { return 1u << ray; }
KD_INLINE RaySet first_rays(size_t count) { return (1u << count) - 1; }
KD_INLINE bool is_single(RaySet set) { return (set & (set - 1)) == 0; }

/// body(ray) for each ray of a set.
template <class Body>
KD_INLINE void for_each_ray(RaySet set, const Body& body) {
  for (; set != kNoRays; set &= set - 1) body(first_of(set));
}

/// What a packet has of each ray.
template <class T>
using PerRay = std::array<T, kPacketRays>;

/// What comparisons of a packet's numbers return.
struct PacketTruths {
  Ints lanes;  // -1 where it holds, else 0

  static PacketTruths in(RaySet set) {
    constexpr Ints kBit = {1, 2, 4, 8, 16, 32, 64, 128};
    return {(kBit & static_cast<int32_t>(set)) != 0};
  }

  /// The rays where it holds.
  KD_INLINE RaySet rays() const {
#if defined(__AVX2__)
    return static_cast<RaySet>(_mm256_movemask_ps(reinterpret_cast<__m256>(lanes)));
#else
    RaySet set = kNoRays;
    for (int i = 0; i < kLanes; ++i) set |= (static_cast<RaySet>(lanes[i]) & 1) << i;
    return set;
#endif
  }

  KD_INLINE friend PacketTruths operator&(PacketTruths a, PacketTruths b) { return {a.lanes & b.lanes}; }
  KD_INLINE friend PacketTruths operator!(PacketTruths a) { return {~a.lanes}; }
};

/// A float32 of each ray. The functions are those that a float has in core/arithmetic.h and the standard library.
struct PacketFloats {
  Floats lanes;

  PacketFloats() = default;
  KD_INLINE PacketFloats(Floats values) : lanes(values) {}
  KD_INLINE PacketFloats(float value) : lanes(splat(value)) {}
  KD_INLINE explicit PacketFloats(const PerRay<float>& values) { std::memcpy(&lanes, values.data(), sizeof lanes); }

  KD_INLINE friend PacketFloats operator-(PacketFloats a) { return -a.lanes; }
  KD_INLINE friend PacketFloats operator-(PacketFloats a, PacketFloats b) { return a.lanes - b.lanes; }
  KD_INLINE friend PacketFloats operator*(PacketFloats a, PacketFloats b) { return a.lanes * b.lanes; }
  KD_INLINE friend PacketTruths operator<(PacketFloats a, PacketFloats b) { return {a.lanes < b.lanes}; }
  KD_INLINE friend PacketTruths operator>(PacketFloats a, PacketFloats b) { return {a.lanes > b.lanes}; }
  KD_INLINE friend PacketTruths operator<=(PacketFloats a, PacketFloats b) { return {a.lanes <= b.lanes}; }
  KD_INLINE friend PacketTruths operator>=(PacketFloats a, PacketFloats b) { return {a.lanes >= b.lanes}; }

  KD_INLINE friend PacketFloats least_of(PacketFloats a, PacketFloats b) {
    return a.lanes < b.lanes ? a.lanes : b.lanes;
  }
  KD_INLINE friend PacketFloats largest_of(PacketFloats a, PacketFloats b) {
    return a.lanes > b.lanes ? a.lanes : b.lanes;
  }
  KD_INLINE friend PacketFloats least_of(PacketFloats a, PacketFloats b, PacketFloats c) {
    return least_of(least_of(a, b), c);
  }
  KD_INLINE friend PacketFloats largest_of(PacketFloats a, PacketFloats b, PacketFloats c) {
    return largest_of(largest_of(a, b), c);
  }
  KD_INLINE friend PacketFloats fabs(PacketFloats a) {
    return reinterpret_cast<Floats>(reinterpret_cast<Ints>(a.lanes) & 0x7fffffff);
  }
  KD_INLINE friend PacketFloats fma(PacketFloats a, PacketFloats b, PacketFloats c) {
#if defined(__AVX2__) && defined(__FMA__)  // g++ makes one instruction of the loop in some places, and forty in others
    return reinterpret_cast<Floats>(_mm256_fmadd_ps(
        reinterpret_cast<__m256>(a.lanes), reinterpret_cast<__m256>(b.lanes), reinterpret_cast<__m256>(c.lanes)));
#else
    for (int i = 0; i < kLanes; ++i) c.lanes[i] = std::fma(a.lanes[i], b.lanes[i], c.lanes[i]);
    return c;
#endif
  }
  KD_INLINE friend PacketTruths signs_differ(PacketFloats a, PacketFloats b, PacketFloats c) {
    const Ints x = reinterpret_cast<Ints>(a.lanes), y = reinterpret_cast<Ints>(b.lanes),
               z = reinterpret_cast<Ints>(c.lanes);
    return {((x ^ y) | (y ^ z)) < 0};
  }
};

}  // namespace kd
