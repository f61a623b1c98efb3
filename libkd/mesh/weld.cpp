#include "mesh/weld.h"

#include <algorithm>
#include <bit>

namespace kd::mesh {

std::vector<uint32_t> weld(std::span<const Vec3d> positions, Watch& watch) {
  // Bits are ordered where NaNs are not; adding 0 turns -0 into 0.
  struct Key {
    uint64_t x, y, z;
    uint32_t index;
    auto operator<=>(const Key&) const = default;
    bool same_point(const Key& k) const { return x == k.x && y == k.y && z == k.z; }
  };
  std::vector<Key> keys;
  keys.reserve(positions.size());
  for (uint32_t i = 0; i < positions.size(); ++i) {
    watch.step();
    const Vec3d p = positions[i] + Vec3d{0, 0, 0};
    keys.push_back({std::bit_cast<uint64_t>(p.x), std::bit_cast<uint64_t>(p.y), std::bit_cast<uint64_t>(p.z), i});
  }
  std::sort(keys.begin(), keys.end(), [&watch](const Key& a, const Key& b) {
    watch.step();
    return a < b;
  });
  std::vector<uint32_t> first_of(positions.size());
  size_t group = 0;
  for (size_t i = 0; i < keys.size(); ++i) {
    watch.step();
    if (!keys[i].same_point(keys[group])) group = i;
    first_of[keys[i].index] = keys[group].index;
  }
  return first_of;
}

std::vector<uint32_t> weld(std::span<const Vec3d> positions) {
  const Progress unwatched;
  Watch watch(unwatched);
  return weld(positions, watch);
}

}  // namespace kd::mesh
