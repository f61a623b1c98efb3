// Eight numbers at once, of doubles four, by the compiler's vector extensions: AVX2 registers, or whatever the
// processor has. For host code.
#pragma once

#include <cstdint>
#include <cstring>

namespace kd {

constexpr int kLanes = 8;
using Ints = int32_t __attribute__((vector_size(4 * kLanes)));
using Floats = float __attribute__((vector_size(4 * kLanes)));
using Longs = int64_t __attribute__((vector_size(4 * kLanes)));
using Doubles = double __attribute__((vector_size(4 * kLanes)));

inline Ints load_lanes(const int32_t* from) {
  Ints v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
inline Ints splat(int32_t value) { return Ints{} + value; }
inline Floats splat(float value) { return value - Floats{}; }  // and not + 0, which would make 0 of -0
inline Floats to_floats(Ints v) { return __builtin_convertvector(v, Floats); }
inline Floats least(Floats a, Floats b) { return a < b ? a : b; }

}  // namespace kd
