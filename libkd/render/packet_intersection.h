// Object intersection and shadow rays by packets, for the CPU: what closest_hit and any_hit (stages/
// object_intersection.h) return for a ray, for up to eight at once, to the bit. Rays whose directions rise along the
// same axes go through the hierarchy together; in an instance's lattice they are sorted again
// (core/packet_traversal.h).
#pragma once

#include <bit>
#include <utility>

#include "core/packet_traversal.h"
#include "render/stages/object_intersection.h"

namespace kd::render {

namespace detail {

/// Rays that rise along the same axes, and how they find instances: see ThroughHierarchy.
struct HierarchyPacket {
  struct Postponed {
    PacketFloats enter;
    PacketTruths inside;  // the rays that pass the box
    uint32_t node;

    /// Whether most of the rays inside another box, which they enter at `other`, enter this one first.
    KD_INLINE bool begins_sooner(PacketFloats other, PacketTruths other_inside) const {
      const RaySet sooner = ((enter < other) & inside & other_inside).rays();
      return 2 * std::popcount(sooner) > std::popcount(other_inside.rays());
    }
  };

  const SceneView& scene;
  BoxTest<PacketFloats> test;
  PerRay<double>& t_limit;

  /// Calls visit(instance, rays); it returns those of them that have found what they look for.
  template <class Visit>
  void for_each(RaySet set, const Visit& visit) const {
    PerRay<float> limits{};
    const auto take_limits = [&](RaySet of) {
      for_each_ray(of, [&](size_t i) { limits[i] = rounded_up(t_limit[i]); });
      return PacketFloats(limits);
    };
    PacketFloats limit = take_limits(set);
    uint32_t here = 0;
    HierarchyNode node = scene.hierarchy[here];
    const Passage<PacketFloats> to_all = test.pass(node, limit);
    PacketFloats enter = to_all.enter;
    PacketTruths inside = to_all.passes() & PacketTruths::in(set);
    if (inside.rays() == kNoRays) return;
    Postponed stack[kMaxHierarchyDepth];
    int open = 0;
    while (true) {
      // An instance waits while what was postponed last begins sooner: a box that holds the ground begins before the
      // houses do, and the ground itself behind them. (On a GPU lanes part over it: a fifth to a third slower there.)
      if (node.is_leaf && open > 0 && stack[open - 1].begins_sooner(enter, inside)) {
        Postponed& top = stack[open - 1];
        std::swap(enter, top.enter);
        std::swap(inside, top.inside);
        std::swap(here, top.node);
        inside = inside & !(enter > limit);
        node = scene.hierarchy[here];
      } else if (node.is_leaf) {
        const RaySet visiting = inside.rays();
        const RaySet done = visit(node.first, visiting);
        for_each_ray(done, [&](size_t i) { t_limit[i] = -std::numeric_limits<double>::infinity(); });
        limit = take_limits(visiting);
        set &= ~done;
        if (set == kNoRays) return;
        inside = PacketTruths::in(kNoRays);
      } else {
        const uint32_t first = node.first;
        const HierarchyNode &a = scene.hierarchy[first], &b = scene.hierarchy[first + 1];
        const Passage<PacketFloats> to_a = test.pass(a, limit), to_b = test.pass(b, limit);
        const PacketTruths in_a = to_a.passes() & inside, in_b = to_b.passes() & inside;
        const RaySet through_a = in_a.rays(), through_b = in_b.rays(), both = through_a & through_b;
        // Where some rays pass both, the child that most of them enter first.
        const RaySet a_sooner = (to_a.enter <= to_b.enter).rays() & both;
        const bool a_first =
            through_b == kNoRays || (through_a != kNoRays && 2 * std::popcount(a_sooner) >= std::popcount(both));
        if (through_a != kNoRays && through_b != kNoRays) {
          stack[open++] = a_first ? Postponed{to_b.enter, in_b, first + 1} : Postponed{to_a.enter, in_a, first};
        }
        enter = a_first ? to_a.enter : to_b.enter;
        inside = a_first ? in_a : in_b;
        here = a_first ? first : first + 1;
        node = a_first ? a : b;
      }
      while (inside.rays() == kNoRays) {
        if (open == 0) return;
        --open;
        enter = stack[open].enter;
        inside = stack[open].inside & !(enter > limit);
        here = stack[open].node;
        node = scene.hierarchy[here];
      }
    }
  }
};

/// The same for packets as Instances::for_each is for a ray; `visit` as for HierarchyPacket.
template <class Instances, class Visit>
void for_each_instance(const SceneView& scene, const BasicRay<PacketDoubles>& rays, RaySet set, PerRay<double>& t_limit,
                       const Visit& visit) {
  if constexpr (Instances::kOnlyOne) {
    visit(0, set);
  } else if (scene.instance_count != 0) {
    const Vec3<PacketDoubles>& d = rays.direction;
    const RaySet up_x = (d.x >= 0).rays(), up_y = (d.y >= 0).rays(), up_z = (d.z >= 0).rays();
    HierarchyPacket packet{scene, slabs_of(rays, scene.hierarchy[0]), t_limit};
    while (set != kNoRays) {
      const RaySet first = set & (0u - set);
      packet.test.rising_x = (up_x & first) != kNoRays;
      packet.test.rising_y = (up_y & first) != kNoRays;
      packet.test.rising_z = (up_z & first) != kNoRays;
      const auto as_first = [&](RaySet up, bool rises) { return rises ? up : ~up; };
      const RaySet alike = set & as_first(up_x, packet.test.rising_x) & as_first(up_y, packet.test.rising_y) &
                           as_first(up_z, packet.test.rising_z);
      packet.for_each(alike, visit);
      set &= ~alike;
    }
  }
}

}  // namespace detail

/// The nearest hits of some rays in the scene, in `best`.
template <class Instances>
void closest_hits(const SceneView& scene, const PerRay<Ray>& rays, RaySet set, PerRay<SurfaceHit>& best) {
  PerRay<double> t_limit{};
  for_each_ray(set, [&](size_t i) {
    best[i] = {};
    t_limit[i] = rays[i].t_max;
  });
  const BasicRay<PacketDoubles> packet = packed(rays, set);
  PacketQuery query;
  query.excluded.fill(kNoTriangle);
  PacketAnswer answer;
  RaySet met = kNoRays;
  detail::for_each_instance<Instances>(scene, packet, set, t_limit, [&](uint32_t index, RaySet visiting) {
    const PacketTruths enters = detail::enter_instance(scene, index, packet, query.rays);
    const PacketFloats limit = detail::limit_in_lattice(query.rays, PacketDoubles(t_limit));
    query.s_limit = select(PacketTruths::in(met), limit, query.rays.s_max);
    const RaySet entering = visiting & (enters & !(query.s_limit < 0)).rays();
    if (entering == kNoRays) return kNoRays;
    const ObjectView& object = scene.objects[scene.instances[index].object].tree;
    Instances::Sides::with_test(scene, index, [&]<class Test>() {
      traverse<RayMode::closest, Test, Instances::kLayout>(object, query, entering, answer);
    });
    for_each_ray(entering, [&](size_t i) {
      if (answer.met[i] == kNoTriangle) return;
      const TriangleHit& hit = answer.hits[i];
      reduce(best[i], {ray_of(query.rays, i).t_at(hit.s), hit.u, hit.v, index, answer.met[i]});
      t_limit[i] = best[i].t;
      met |= set_of(i);
    });
    return kNoRays;
  });
}

/// Which of some rays meet anything but what they exclude.
template <class Instances>
RaySet any_hits(const SceneView& scene, const PerRay<Ray>& rays, const PerRay<Excluded>& excluded, RaySet set) {
  PerRay<double> t_limit{};
  for_each_ray(set, [&](size_t i) { t_limit[i] = rays[i].t_max; });
  const BasicRay<PacketDoubles> packet = packed(rays, set);
  PacketQuery query;
  PacketAnswer answer;
  RaySet shadowed = kNoRays;
  detail::for_each_instance<Instances>(scene, packet, set, t_limit, [&](uint32_t index, RaySet visiting) {
    const RaySet entering = visiting & detail::enter_instance(scene, index, packet, query.rays).rays();
    if (entering == kNoRays) return kNoRays;
    query.s_limit = query.rays.s_max;
    for_each_ray(entering, [&](size_t i) {
      query.excluded[i] = excluded[i].instance == index ? excluded[i].triangle : kNoTriangle;
    });
    const ObjectView& object = scene.objects[scene.instances[index].object].tree;
    traverse<RayMode::any, ExactTest, Instances::kLayout>(object, query, entering, answer);
    RaySet done = kNoRays;
    for_each_ray(entering, [&](size_t i) { done |= answer.met[i] != kNoTriangle ? set_of(i) : kNoRays; });
    shadowed |= done;
    return done;
  });
  return shadowed;
}

}  // namespace kd::render
