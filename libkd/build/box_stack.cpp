#include "build/box_stack.h"

#include <algorithm>

namespace kd::build {

void BoxStack::reserve(size_t count) {
  const size_t wanted = size + count;
  if (wanted <= triangles.size()) return;
  const size_t capacity = std::max(wanted, 2 * triangles.size());
  for (Interval& axis : axes) {
    axis.lo.resize(capacity);
    axis.hi.resize(capacity);
  }
  triangles.resize(capacity);
}

void BoxStack::push(uint32_t triangle, const Box3u& box) {
  for (int k = 0; k < 3; ++k) {
    axes[static_cast<size_t>(k)].lo[size] = static_cast<int32_t>(box.lo[k]);
    axes[static_cast<size_t>(k)].hi[size] = static_cast<int32_t>(box.hi[k]);
  }
  triangles[size++] = triangle;
}

Box3u BoxStack::box(size_t i) const {
  const auto corner = [i](const std::vector<int32_t>& x, const std::vector<int32_t>& y, const std::vector<int32_t>& z) {
    return vec_cast<uint32_t>(Vec3<int32_t>{x[i], y[i], z[i]});
  };
  return {corner(axes[0].lo, axes[1].lo, axes[2].lo), corner(axes[0].hi, axes[1].hi, axes[2].hi)};
}

}  // namespace kd::build
