// Traversal by a packet: up to eight rays go through one object's kd-tree together and read each node and triangle
// once (Wald, Slusallek, Benthin, Wagner, "Interactive Rendering with Coherent Ray Tracing", Eurographics 2001). For
// the CPU. It returns what core/traversal.h returns for each ray alone, to the bit.
//
// The rays of a packet share their axis and the octant of their directions, so that they meet a node's children in one
// order; `traverse` below sorts any eight rays into such packets. Each keeps a cell interval of its own, by the same
// arithmetic and margins as a ray alone, and so loses no cell; while some enter a child, the others wait. The float32
// filter of the exact test rejects triangles for all rays at once; where it is certain of some that pass through, these
// get their distances together, and what it leaves undecided is decided ray by ray.
#pragma once

#include <limits>

#include "core/lattice_packet.h"
#include "core/traversal.h"

namespace kd {

/// What `traverse` takes for a ray, for each of a packet.
struct PacketQuery {
  LatticePacket rays;
  PacketFloats s_limit;
  PerRay<uint32_t> excluded;
};

/// What it returns for each, and of closest hits where they are, as ExactTest::locate has it.
struct PacketAnswer {
  PerRay<uint32_t> met;
  PerRay<TriangleHit> hits;
};

namespace detail {

struct PacketEntry {
  PacketFloats s_entry, s_exit;
  PacketTruths inside;  // the rays that enter the cell
  uint32_t node;
};

/// The nearest hits so far of a packet's rays.
template <RayMode mode, class Test>
class PacketHits {
 public:
  PacketHits(const PacketQuery& query, int axis, RaySet rays, PacketAnswer& answer)
      : shear(shear_along(query.rays, axis)), query_(query), sign_(query.rays.direction[axis]), answer_(answer) {
    const PacketFloats limit = least_of(query.rays.s_max, query.s_limit);
    for_each_ray(rays, [&](size_t i) {
      answer_.met[i] = kNoTriangle;
      nearest_[i] = s_best_[i] = limit[i];
    });
  }

  const Shear<PacketFloats> shear;

  /// The distances of the nearest hits, rounded up.
  KD_INLINE PacketFloats s_best() const { return PacketFloats(s_best_); }

  /// Tests the rays of `open` exactly; returns those that look for nothing else. A function of its own, so that the
  /// loop that calls it for one triangle in ten keeps its vectors in registers.
  [[gnu::noinline]] RaySet decide(uint32_t candidate, const TriangleVertices& triangle, RaySet certain, RaySet open) {
    RaySet done = kNoRays;
    const auto nearer = [&](size_t i, double s) {
      if (s < query_.rays.s_min[i] || s > nearest_[i]) return false;
      if constexpr (mode == RayMode::any) {
        s_best_[i] = -std::numeric_limits<float>::infinity();  // it enters no other cell
        done |= set_of(i);
      } else {
        if (!(s < nearest_[i] || candidate < answer_.met[i])) return false;
        nearest_[i] = s;
        s_best_[i] = rounded_up(s);
      }
      answer_.met[i] = candidate;
      return true;
    };
    for_each_ray(open, [&](size_t i) { open &= candidate == query_.excluded[i] ? ~set_of(i) : ~kNoRays; });
    RaySet single = open;
    if constexpr (std::is_same_v<Test, ExactTest>) {
      const RaySet together = certain & open;  // they pass through
      if (std::popcount(together) >= kWorthwhile) {
        const auto w = shear.weigh<PacketDoubles>(triangle);
        const PacketDoubles inverse = w.inverse_sum();
        const PacketDoubles s = w.distance_times_sum(sign_) * inverse, u = w.v * inverse, v = w.w * inverse;
        for_each_ray(together, [&](size_t i) {
          if (nearer(i, s[i])) answer_.hits[i] = {s[i], u[i], v[i]};
        });
        single &= ~together;
      }
    }
    for_each_ray(single, [&](size_t i) {
      const Test test(ray_of(query_.rays, i));
      NoCounter counter;
      double s;
      if (!test.template meets<mode>(triangle, s_best_[i], s, counter) || !nearer(i, s)) return;
      if constexpr (mode == RayMode::closest) answer_.hits[i] = test.locate(triangle);
    });
    return done;
  }

 private:
  /// From how many rays on eight together take less time than one by one.
  static constexpr int kWorthwhile = 3;

  const PacketQuery& query_;
  PacketFloats sign_;
  PacketAnswer& answer_;
  PerRay<double> nearest_;
  alignas(32) PerRay<float> s_best_{};
};

/// For rays of one axis and octant; answers for these.
template <RayMode mode, class Test, TriangleLayout layout>
void traverse_packet(const ObjectView& object, const PacketQuery& query, RaySet rays, PacketAnswer& answer) {
  const size_t first = first_of(rays);
  PacketHits<mode, Test> hits(query, query.rays.axis[first], rays, answer);
  PacketEntry stack[kMaxDepth];
  int depth = 0;

  const Vec3<PacketFloats>&o = query.rays.origin, &per_step = query.rays.inverse;
  const std::array<PacketFloats, 3> origin{o.x, o.y, o.z}, inverse{per_step.x, per_step.y, per_step.z};
  const auto is_down = [&](PacketFloats component) { return std::bit_cast<uint32_t>(component[first]) >> 31; };
  const std::array<uint32_t, 3> downward{is_down(per_step.x), is_down(per_step.y), is_down(per_step.z)};

  PacketFloats s_entry = query.rays.s_min, s_exit = least_of(query.rays.s_exit, hits.s_best()) * kMargin;
  PacketTruths inside = PacketTruths::in(rays);
  Node node = object.nodes[0];

  while (true) {
    while (!is_leaf(node)) {
      const auto axis = static_cast<size_t>(split_axis(node));
      const PacketFloats s = (split_plane(node) - origin[axis]) * inverse[axis], s_more = s * kMargin;
      const uint32_t down = downward[axis];
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
      const auto decision = hits.shear.filter(triangle);
      const RaySet open = (inside & !(decision.certain & decision.apart)).rays();
      if (open == kNoRays) continue;
      const RaySet done = hits.decide(candidate, triangle, decision.certain.rays(), open);
      if (mode == RayMode::any && done != kNoRays) {
        rays &= ~done;
        if (rays == kNoRays) return;
        inside = inside & PacketTruths::in(rays);
      }
    }

    // Back to the nearest cell that some ray enters before its nearest hit. An entry is the plane's distance as
    // computed, so a margin is taken off before a hit counts as nearer.
    const PacketFloats s_best = hits.s_best();
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

/// For each of `rays` what core/traversal.h returns for it. Test is an exact one.
template <RayMode mode, class Test = ExactTest, TriangleLayout layout = TriangleLayout::expanded>
void traverse(const ObjectView& object, const PacketQuery& query, RaySet rays, PacketAnswer& answer) {
  static_assert(Test::kExact);
  const auto sign = [](PacketFloats a, int bit) { return (reinterpret_cast<Ints>(a.lanes) < 0) & bit; };
  const LatticePacket& packet = query.rays;
  const Ints octant = sign(packet.inverse.x, 1) | sign(packet.inverse.y, 2) | sign(packet.inverse.z, 4);
  const Ints kind = octant | (packet.axis.x.lanes & 8) | (packet.axis.y.lanes & 16);
  while (rays != kNoRays) {
    const size_t first = first_of(rays);
    const RaySet alike = PacketTruths{kind == kind[first]}.rays() & rays;
    rays &= ~alike;
    if (!is_single(alike)) {
      detail::traverse_packet<mode, Test, layout>(object, query, alike, answer);
      continue;
    }
    const LatticeRay ray = ray_of(packet, first);
    NoCounter counter;
    const uint32_t met =
        traverse<mode, Test, layout>(object, ray, query.s_limit[first], query.excluded[first], counter);
    answer.met[first] = met;
    if (mode == RayMode::closest && met != kNoTriangle)
      answer.hits[first] = Test(ray).locate(object.triangle<layout>(met));
  }
}

}  // namespace kd
