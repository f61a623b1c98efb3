// Axis-aligned boxes. An empty box has lo > hi, and grows by `extend`.
#pragma once

#include <algorithm>
#include <limits>

#include "core/vec.h"

namespace kd {

template <class T>
struct Box3 {
  Vec3<T> lo{std::numeric_limits<T>::max(), std::numeric_limits<T>::max(), std::numeric_limits<T>::max()};
  Vec3<T> hi{std::numeric_limits<T>::lowest(), std::numeric_limits<T>::lowest(), std::numeric_limits<T>::lowest()};

  constexpr void extend(Vec3<T> p) {
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
  }
  /// By an empty box not at all.
  constexpr void extend(const Box3& b) {
    lo = {std::min(lo.x, b.lo.x), std::min(lo.y, b.lo.y), std::min(lo.z, b.lo.z)};
    hi = {std::max(hi.x, b.hi.x), std::max(hi.y, b.hi.y), std::max(hi.z, b.hi.z)};
  }
  constexpr bool empty() const { return lo.x > hi.x || lo.y > hi.y || lo.z > hi.z; }
  constexpr Vec3<T> extent() const { return hi - lo; }

  friend constexpr bool operator==(const Box3&, const Box3&) = default;
};

using Box3d = Box3<double>;
using Box3f = Box3<float>;
using Box3u = Box3<uint32_t>;

}  // namespace kd
