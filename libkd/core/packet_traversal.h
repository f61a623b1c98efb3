// Traversal by a packet: up to eight rays go through one object's kd-tree together and read each node and triangle
// once (Wald, Slusallek, Benthin, Wagner, "Interactive Rendering with Coherent Ray Tracing", Eurographics 2001). For
// the CPU. It returns what core/traversal.h returns for each ray alone, to the bit.
//
// The rays of a packet share their axis and the octant of their directions, so that they meet a node's children in one
// order; `traverse` below sorts any eight rays into such packets. Each keeps a cell interval of its own, by the same
// arithmetic and margins as a ray alone, and so loses no cell; while some enter a child, the others wait. The float32
// filter of the exact test rejects triangles for all rays at once; what it leaves is decided ray by ray.
#pragma once

#include <limits>

#include "core/packet.h"
#include "core/traversal.h"

namespace kd {

/// What `traverse` takes for a ray, for each of a packet.
struct PacketQuery {
  PerRay<LatticeRay> rays;
  PerRay<float> s_limit;
  PerRay<uint32_t> excluded;
};

namespace detail {

/// Rays of one axis and one octant, by components.
struct Packet {
  std::array<PacketFloats, 3> origin, inverse;
  PacketFloats s_min, s_exit;
  std::array<uint32_t, 3> down;  // along each axis: 1 where the rays go towards lower coordinates
  Shear<PacketFloats> shear;

  Packet(const PerRay<LatticeRay>& rays, RaySet set) {
    enum { kOrigin, kInverse = 3, kSMin = 6, kSExit, kSlopeX, kSlopeY, kNumbers };
    alignas(32) std::array<PerRay<float>, kNumbers> of{};
    for_each_ray(set, [&](size_t i) {
      const LatticeRay& ray = rays[i];
      const Shear<float> one = shear_along(ray);
      of[kOrigin][i] = ray.origin.x;
      of[kOrigin + 1][i] = ray.origin.y;
      of[kOrigin + 2][i] = ray.origin.z;
      of[kInverse][i] = ray.inverse.x;
      of[kInverse + 1][i] = ray.inverse.y;
      of[kInverse + 2][i] = ray.inverse.z;
      of[kSMin][i] = ray.s_min;
      of[kSExit][i] = ray.s_exit;
      of[kSlopeX][i] = one.slope_x;
      of[kSlopeY][i] = one.slope_y;
    });
    const LatticeRay& first = rays[first_of(set)];
    for (size_t axis = 0; axis < 3; ++axis) {
      origin[axis] = PacketFloats(of[kOrigin + axis]);
      inverse[axis] = PacketFloats(of[kInverse + axis]);
      down[axis] = std::bit_cast<uint32_t>(first.inverse[static_cast<int>(axis)]) >> 31;
    }
    s_min = PacketFloats(of[kSMin]);
    s_exit = PacketFloats(of[kSExit]);
    shear = {{origin[0], origin[1], origin[2]},
             PacketFloats(of[kSlopeX]),
             PacketFloats(of[kSlopeY]),
             first.axis == 0,
             first.axis == 1};
  }
};

struct PacketEntry {
  PacketFloats s_entry, s_exit;
  PacketTruths inside;  // the rays that enter the cell
  uint32_t node;
};

/// The nearest hits so far of a packet's rays.
template <RayMode mode, class Test>
struct PacketHits {
  const PacketQuery& query;
  PerRay<uint32_t>& met;
  PerRay<double> nearest;
  alignas(32) PerRay<float> s_best{};  // rounded up

  PacketHits(const PacketQuery& asked, RaySet set, PerRay<uint32_t>& answer) : query(asked), met(answer) {
    for_each_ray(set, [&](size_t i) {
      met[i] = kNoTriangle;
      nearest[i] = s_best[i] = min_of(query.rays[i].s_max, query.s_limit[i]);
    });
  }

  /// Tests the rays of `open` one by one; returns those that look for nothing else. A function of its own, so that the
  /// loop that calls it for one triangle in ten keeps its vectors in registers.
  [[gnu::noinline]] RaySet decide(uint32_t candidate, const TriangleVertices& triangle, RaySet open) {
    NoCounter counter;
    RaySet done = kNoRays;
    for_each_ray(open, [&](size_t i) {
      typename Test::Distance s;
      if (candidate == query.excluded[i]) return;
      if (!Test(query.rays[i]).template meets<mode>(triangle, s_best[i], s, counter)) return;
      if (s < query.rays[i].s_min || s > nearest[i]) return;
      if constexpr (mode == RayMode::any) {
        met[i] = candidate;
        s_best[i] = -std::numeric_limits<float>::infinity();  // it enters no other cell
        done |= set_of(i);
      } else if (s < nearest[i] || candidate < met[i]) {
        nearest[i] = s;
        s_best[i] = rounded_up(s);
        met[i] = candidate;
      }
    });
    return done;
  }
};

/// For rays of one axis and octant; writes `met` of these.
template <RayMode mode, class Test, TriangleLayout layout>
void traverse_packet(const ObjectView& object, const PacketQuery& query, RaySet rays, PerRay<uint32_t>& met) {
  const Packet packet(query.rays, rays);
  PacketHits<mode, Test> hits(query, rays, met);
  PacketEntry stack[kMaxDepth];
  int depth = 0;

  PacketFloats s_entry = packet.s_min, s_exit = least_of(packet.s_exit, PacketFloats(hits.s_best)) * kMargin;
  PacketTruths inside = PacketTruths::in(rays);
  Node node = object.nodes[0];

  while (true) {
    while (!is_leaf(node)) {
      const auto axis = static_cast<size_t>(split_axis(node));
      const PacketFloats s = (split_plane(node) - packet.origin[axis]) * packet.inverse[axis], s_more = s * kMargin;
      const uint32_t down = packet.down[axis];
      const uint32_t near = first_child(node) + down, far = first_child(node) + 1 - down;
      const uint32_t near_empty = kLowerEmpty << down, far_empty = near_empty ^ (kLowerEmpty | kUpperEmpty);
      const PacketTruths in_near = (s_more >= s_entry) & inside, in_far = (s <= s_exit) & inside;
      const bool to_near = (node.link & near_empty) == 0 && in_near.rays() != kNoRays;
      const bool to_far = (node.link & far_empty) == 0 && in_far.rays() != kNoRays;
      if (to_near) {
        if (to_far) stack[depth++] = {largest_of(s_entry, s), s_exit, in_far, far};
        s_exit = least_of(s_exit, s_more);
        inside = in_near;
        node = object.nodes[near];
      } else {
        s_entry = largest_of(s_entry, s);
        inside = in_far;
        node = object.nodes[to_far ? far : kEmptyLeaf];
      }
    }

    const uint32_t begin = first_reference(node), end = begin + reference_count(node);
    if constexpr (layout == TriangleLayout::expanded) {
      for (uint32_t r = begin; r < end; ++r) __builtin_prefetch(object.triangles + object.references[r]);
    }
    for (uint32_t r = begin; r < end; ++r) {
      const uint32_t candidate = object.references[r];
      const TriangleVertices triangle = object.triangle<layout>(candidate);
      const auto decision = packet.shear.filter(triangle);
      const RaySet open = (inside & !(decision.certain & decision.apart)).rays();
      if (open == kNoRays) continue;
      const RaySet done = hits.decide(candidate, triangle, open);
      if (mode == RayMode::any && done != kNoRays) {
        rays &= ~done;
        if (rays == kNoRays) return;
        inside = inside & PacketTruths::in(rays);
      }
    }

    // Back to the nearest cell that some ray enters before its nearest hit. An entry is the plane's distance as
    // computed, so a margin is taken off before a hit counts as nearer.
    const PacketFloats s_best(hits.s_best);
    do {
      if (depth == 0) return;
      --depth;
      s_entry = stack[depth].s_entry;
      inside = stack[depth].inside & (s_best >= s_entry * kResumeMargin);
    } while (inside.rays() == kNoRays);
    s_exit = least_of(stack[depth].s_exit, s_best * kMargin);
    node = object.nodes[stack[depth].node];
  }
}

}  // namespace detail

/// For each of `rays` what core/traversal.h returns for it, in `met`. Test is an exact one.
template <RayMode mode, class Test = ExactTest, TriangleLayout layout = TriangleLayout::expanded>
void traverse(const ObjectView& object, const PacketQuery& query, RaySet rays, PerRay<uint32_t>& met) {
  static_assert(Test::kExact);
  PerRay<uint32_t> kind;  // axis and octant
  for_each_ray(rays, [&](size_t i) {
    const LatticeRay& ray = query.rays[i];
    const auto negative = [](float x) { return std::bit_cast<uint32_t>(x) >> 31; };
    kind[i] = static_cast<uint32_t>(ray.axis) << 3 | negative(ray.inverse.x) << 2 | negative(ray.inverse.y) << 1 |
              negative(ray.inverse.z);
  });
  while (rays != kNoRays) {
    const size_t first = first_of(rays);
    RaySet alike = kNoRays;
    for_each_ray(rays, [&](size_t i) { alike |= kind[i] == kind[first] ? set_of(i) : kNoRays; });
    if (is_single(alike)) {
      NoCounter counter;
      met[first] =
          traverse<mode, Test, layout>(object, query.rays[first], query.s_limit[first], query.excluded[first], counter);
    } else {
      detail::traverse_packet<mode, Test, layout>(object, query, alike, met);
    }
    rays &= ~alike;
  }
}

}  // namespace kd
