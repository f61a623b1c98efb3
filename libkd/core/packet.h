// The numbers of a packet of eight rays, in registers: what core/ computes with where it takes a packet in place of a
// ray. For host code.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#if defined(__AVX2__) && defined(__FMA__)
#include <immintrin.h>
#endif

#include "core/lanes.h"
#include "core/platform.h"
#include "core/ray.h"
#include "core/vec.h"

namespace kd {

constexpr size_t kPacketRays = kLanes;

/// A set of a packet's rays: bit i is ray i.
using RaySet = uint32_t;
constexpr RaySet kNoRays = 0;

KD_INLINE size_t first_of(RaySet set) { return static_cast<size_t>(std::countr_zero(set)); }
KD_INLINE RaySet set_of(size_t ray) { return 1u << ray; }
KD_INLINE constexpr RaySet first_rays(size_t count) { return (1u << count) - 1; }
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
  KD_INLINE friend PacketTruths operator|(PacketTruths a, PacketTruths b) { return {a.lanes | b.lanes}; }
  KD_INLINE friend PacketTruths operator!(PacketTruths a) { return {~a.lanes}; }
  KD_INLINE friend bool any(PacketTruths a) { return a.rays() != kNoRays; }
  KD_INLINE friend bool all(PacketTruths a) { return a.rays() == first_rays(kPacketRays); }
};

/// A float32 of each ray. The functions are those that a float has in core/arithmetic.h and the standard library.
struct PacketFloats {
  Floats lanes;

  KD_INLINE float operator[](size_t ray) const { return lanes[ray]; }

  PacketFloats() = default;
  KD_INLINE PacketFloats(Floats values) : lanes(values) {}
  KD_INLINE PacketFloats(float value) : lanes(splat(value)) {}
  KD_INLINE explicit PacketFloats(const PerRay<float>& values) { std::memcpy(&lanes, values.data(), sizeof lanes); }

  KD_INLINE friend PacketFloats operator-(PacketFloats a) { return -a.lanes; }
  KD_INLINE friend PacketFloats operator-(PacketFloats a, PacketFloats b) { return a.lanes - b.lanes; }
  KD_INLINE friend PacketFloats operator*(PacketFloats a, PacketFloats b) { return a.lanes * b.lanes; }
  KD_INLINE friend PacketTruths operator==(PacketFloats a, PacketFloats b) { return {a.lanes == b.lanes}; }
  KD_INLINE friend PacketTruths operator<(PacketFloats a, PacketFloats b) { return {a.lanes < b.lanes}; }
  KD_INLINE friend PacketTruths operator>(PacketFloats a, PacketFloats b) { return {a.lanes > b.lanes}; }
  KD_INLINE friend PacketTruths operator<=(PacketFloats a, PacketFloats b) { return {a.lanes <= b.lanes}; }
  KD_INLINE friend PacketTruths operator>=(PacketFloats a, PacketFloats b) { return {a.lanes >= b.lanes}; }

  KD_INLINE friend PacketFloats select(PacketTruths which, PacketFloats a, PacketFloats b) {
    return which.lanes ? a.lanes : b.lanes;
  }
  KD_INLINE friend PacketFloats reciprocal(PacketFloats a) { return 1 / a.lanes; }
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

/// A double of each ray, likewise.
struct PacketDoubles {
  Doubles low, high;

  PacketDoubles() = default;
  KD_INLINE PacketDoubles(Doubles l, Doubles h) : low(l), high(h) {}
  KD_INLINE PacketDoubles(double value) : low(value - Doubles{}), high(low) {}
  KD_INLINE PacketDoubles(PacketFloats a)
      : low(__builtin_convertvector(__builtin_shufflevector(a.lanes, a.lanes, 0, 1, 2, 3), Doubles)),
        high(__builtin_convertvector(__builtin_shufflevector(a.lanes, a.lanes, 4, 5, 6, 7), Doubles)) {}
  KD_INLINE explicit PacketDoubles(const PerRay<double>& values) {
    std::memcpy(&low, values.data(), sizeof low);
    std::memcpy(&high, values.data() + kPacketRays / 2, sizeof high);
  }

  KD_INLINE double operator[](size_t ray) const {
    return ray < kPacketRays / 2 ? low[ray] : high[ray - kPacketRays / 2];
  }

  KD_INLINE friend PacketDoubles operator-(PacketDoubles a) { return {-a.low, -a.high}; }
  KD_INLINE friend PacketDoubles operator+(PacketDoubles a, PacketDoubles b) {
    return {a.low + b.low, a.high + b.high};
  }
  KD_INLINE friend PacketDoubles operator-(PacketDoubles a, PacketDoubles b) {
    return {a.low - b.low, a.high - b.high};
  }
  KD_INLINE friend PacketDoubles operator*(PacketDoubles a, PacketDoubles b) {
    return {a.low * b.low, a.high * b.high};
  }
  KD_INLINE friend PacketDoubles operator/(PacketDoubles a, PacketDoubles b) {
    return {a.low / b.low, a.high / b.high};
  }
  KD_INLINE friend PacketTruths operator<(PacketDoubles a, PacketDoubles b) {
    return truths(a.low < b.low, a.high < b.high);
  }
  KD_INLINE friend PacketTruths operator>(PacketDoubles a, PacketDoubles b) {
    return truths(a.low > b.low, a.high > b.high);
  }
  KD_INLINE friend PacketTruths operator<=(PacketDoubles a, PacketDoubles b) {
    return truths(a.low <= b.low, a.high <= b.high);
  }
  KD_INLINE friend PacketTruths operator>=(PacketDoubles a, PacketDoubles b) {
    return truths(a.low >= b.low, a.high >= b.high);
  }
  KD_INLINE friend PacketTruths operator==(PacketDoubles a, PacketDoubles b) {
    return truths(a.low == b.low, a.high == b.high);
  }
  KD_INLINE friend PacketTruths operator!=(PacketDoubles a, PacketDoubles b) {
    return truths(a.low != b.low, a.high != b.high);
  }

  KD_INLINE friend PacketDoubles select(PacketTruths which, PacketDoubles a, PacketDoubles b) {
    const Ints w = which.lanes;
    return {__builtin_convertvector(__builtin_shufflevector(w, w, 0, 1, 2, 3), Longs) ? a.low : b.low,
            __builtin_convertvector(__builtin_shufflevector(w, w, 4, 5, 6, 7), Longs) ? a.high : b.high};
  }
  KD_INLINE friend PacketDoubles min_of(PacketDoubles a, PacketDoubles b) {
    return {a.low < b.low ? a.low : b.low, a.high < b.high ? a.high : b.high};
  }
  KD_INLINE friend PacketDoubles max_of(PacketDoubles a, PacketDoubles b) {
    return {a.low > b.low ? a.low : b.low, a.high > b.high ? a.high : b.high};
  }
  KD_INLINE friend PacketDoubles max_of(PacketDoubles a, PacketDoubles b, PacketDoubles c) {
    return max_of(max_of(a, b), c);
  }
  KD_INLINE friend PacketFloats rounded_up(PacketDoubles a) {
    const PacketFloats nearest = to_float(a);
    const Ints bits = reinterpret_cast<Ints>(nearest.lanes), up = bits + (nearest.lanes < 0 ? splat(-1) : splat(1));
    return (PacketDoubles(nearest) < a).lanes ? reinterpret_cast<Floats>(up) : nearest.lanes;
  }
  KD_INLINE friend PacketFloats to_float(PacketDoubles a) {
    using Half = float __attribute__((vector_size(2 * kLanes)));
    return __builtin_shufflevector(__builtin_convertvector(a.low, Half), __builtin_convertvector(a.high, Half), 0, 1, 2,
                                   3, 4, 5, 6, 7);
  }
  KD_INLINE friend PacketDoubles fabs(PacketDoubles a) { return {without_sign(a.low), without_sign(a.high)}; }
  KD_INLINE friend PacketDoubles copysign(PacketDoubles a, PacketDoubles b) {
    const auto half = [](Doubles x, Doubles y) {
      return reinterpret_cast<Doubles>(reinterpret_cast<Longs>(without_sign(x)) | (reinterpret_cast<Longs>(y) & kSign));
    };
    return {half(a.low, b.low), half(a.high, b.high)};
  }
  KD_INLINE friend PacketDoubles fma(PacketDoubles a, PacketDoubles b, PacketDoubles c) {
    return {fused(a.low, b.low, c.low), fused(a.high, b.high, c.high)};
  }

 private:
  static constexpr int64_t kSign = std::numeric_limits<int64_t>::min();

  KD_INLINE static PacketTruths truths(Longs l, Longs h) {
    return {__builtin_shufflevector(reinterpret_cast<Ints>(l), reinterpret_cast<Ints>(h), 0, 2, 4, 6, 8, 10, 12, 14)};
  }
  KD_INLINE static Doubles without_sign(Doubles a) {
    return reinterpret_cast<Doubles>(reinterpret_cast<Longs>(a) & ~kSign);
  }
  KD_INLINE static Doubles fused(Doubles a, Doubles b, Doubles c) {
#if defined(__AVX2__) && defined(__FMA__)
    return reinterpret_cast<Doubles>(
        _mm256_fmadd_pd(reinterpret_cast<__m256d>(a), reinterpret_cast<__m256d>(b), reinterpret_cast<__m256d>(c)));
#else
    for (int i = 0; i < kLanes / 2; ++i) c[i] = std::fma(a[i], b[i], c[i]);
    return c;
#endif
  }
};

/// Some rays of a packet, by components; of the others zeros.
inline BasicRay<PacketDoubles> packed(const PerRay<Ray>& rays, RaySet set) {
  enum { kOrigin, kDirection = 3, kTMin = 6, kTMax, kNumbers };
  alignas(32) std::array<PerRay<double>, kNumbers> of{};
  for_each_ray(set, [&](size_t i) {
    for (size_t axis = 0; axis < 3; ++axis) {
      of[kOrigin + axis][i] = rays[i].origin[static_cast<int>(axis)];
      of[kDirection + axis][i] = rays[i].direction[static_cast<int>(axis)];
    }
    of[kTMin][i] = rays[i].t_min;
    of[kTMax][i] = rays[i].t_max;
  });
  const auto number = [&](size_t n) { return PacketDoubles(of[n]); };
  return {{number(kOrigin), number(kOrigin + 1), number(kOrigin + 2)},
          {number(kDirection), number(kDirection + 1), number(kDirection + 2)},
          number(kTMin),
          number(kTMax)};
}

}  // namespace kd
