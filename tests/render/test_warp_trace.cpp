// Rays whose work a warp's lanes share, without a GPU: they meet what each of them meets alone, to the bit.
#include <cstring>
#include <memory>

#include <doctest/doctest.h>

#include "ray_records.h"
#include "warp_emulation.h"
// After what it is to call.
#include "render/cuda/warp_trace.h"

using namespace kd;
using namespace kd::test;
using namespace kd::render;

namespace {

/// The same tree with a leaf of its own for each empty child, as a file may have it.
std::vector<Node> with_empty_leaves(const std::vector<Node>& nodes) {
  std::vector<Node> out(2);
  const auto copy = [&](const auto& self, uint32_t from, uint32_t to) -> void {
    const Node node = nodes[from];
    if (is_leaf(node)) {
      out[to] = node;
      return;
    }
    const auto first = static_cast<uint32_t>(out.size());
    out.resize(first + 2);
    out[to] = make_inner(split_axis(node), static_cast<uint32_t>(split_plane(node)), first);
    for (uint32_t side = 0; side < 2; ++side) self(self, child_of(node, side), first + side);
  };
  copy(copy, 0, 0);
  return out;
}

/// How many rays fare otherwise than alone, traced by a block of so many warps; adds their hits to `met`.
template <RayMode mode>
size_t differing(const Traced& traced, std::span<const RayRecord> rays, uint32_t warps, size_t& met) {
  const TraceView view{traced.view(), invert(traced.lattice.frame()), nullptr};
  constexpr HitRecord kUntouched{-7, -7, -7, -7};
  std::vector<HitRecord> hits(rays.size(), kUntouched);
  const auto shared = std::make_unique<WarpRays[]>(warps);
  std::memset(static_cast<void*>(shared.get()), 0xcd, warps * sizeof(WarpRays));  // as a block finds it: anything
  volatile bool none_left = false;
  uint32_t taken = 0;
  WarpEmulation(warps, shared.get()).run([&](uint32_t warp) {
    detail::StackEntry stack[kMaxDepth];
    WarpTrace<mode, TriangleLayout::expanded> lane(view, shared[warp], stack, none_left);
    lane.run(rays.data(), static_cast<uint32_t>(rays.size()), &taken, hits.data());
  });
  NoCounter counter;
  size_t wrong = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const HitRecord alone = trace_ray<mode, ExactTest, TriangleLayout::expanded>(view, rays[i], counter);
    met += alone.primitive >= 0;
    wrong += mode == RayMode::any ? (alone.primitive < 0) != (hits[i].primitive < 0) || hits[i].primitive < -1
                                  : std::memcmp(&alone, &hits[i], sizeof alone) != 0;
  }
  return wrong;
}

}  // namespace

TEST_CASE("warp trace: rays meet what they meet alone") {
  size_t rays = 0, met = 0;
  for (const int bits : {10, 21, 24}) {
    const uint32_t top = lattice_max(bits);
    for (const Shape& shape :
         {soup_shape(bits, 40, Soup::needles, 1), soup_shape(bits, 700, Soup::mixed, 2),
          soup_shape(bits, 2000, Soup::small, 3), rooms_shape(bits, 6, 4), sphere_shape(bits, 3), fan_shape(bits, 100),
          stacked_boxes_shape(bits, 5), box_shape({0, 0, 0}, {top, top, top})}) {
      Traced traced(shape, bits);
      // Fewer than lanes, as many, a few more, which share stacks; many, of which lanes take others.
      constexpr struct {
        size_t count;
        uint32_t warps;
      } kRays[] = {{1, 1}, {5, 1}, {32, 1}, {33, 1}, {77, 1}, {400, 1}, {70, 2}, {200, 3}};
      for (const auto& [count, warps] : kRays) {
        const std::vector<RayRecord> some =
            adversarial_records(shape, traced.lattice, count, 100 * static_cast<uint64_t>(bits) + count);
        CHECK(differing<RayMode::closest>(traced, some, warps, met) == 0);
        CHECK(differing<RayMode::any>(traced, some, warps, met) == 0);
        rays += 2 * count;
      }
      traced.tree.nodes = with_empty_leaves(traced.tree.nodes);
      const std::vector<RayRecord> some = adversarial_records(shape, traced.lattice, 300, static_cast<uint64_t>(bits));
      CHECK(differing<RayMode::closest>(traced, some, 1, met) == 0);
      CHECK(differing<RayMode::any>(traced, some, 1, met) == 0);
      rays += 2 * some.size();
    }
  }
  CHECK(met > rays / 2);
}
