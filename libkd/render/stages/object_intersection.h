// Object intersection: a ray against every instance whose box it passes, each through the object's own kd-tree.
#pragma once

#include "core/traversal.h"
#include "render/stages/intersection_reduction.h"
#include "render/stages/ray_generation.h"
#include "render/view.h"

namespace kd::render {

/// What a shadow ray starts on, and so never meets.
struct Excluded {
  uint32_t instance = kNone;
  uint32_t triangle = kNone;
};

/// Which sides of an instance's surfaces a camera ray meets, as a triangle test: visit.operator()<Test>() is called
/// with it. A shadow ray meets both, everywhere.
struct BothSides {
  template <class Visit>
  KD_HD KD_INLINE static auto with_test(const SceneView&, uint32_t, const Visit& visit) {
    return visit.template operator()<ExactTest>();
  }
};

/// Of some instances the fronts alone. The lattice is wound as the mesh is, however an instance is placed, mirrored
/// ones too.
struct SidesAsAsked {
  template <class Visit>
  KD_HD KD_INLINE static auto with_test(const SceneView& scene, uint32_t instance, const Visit& visit) {
    if (!scene.front_only[instance]) return visit.template operator()<ExactTest>();
    return visit.template operator()<FrontTest>();
  }
};

/// How a ray finds the instances that it may meet: these have the same interface.
///
/// Calls visit(instance) for instances whose boxes the ray passes, nearer boxes first, while visit returns true. Boxes
/// that begin beyond `t_limit`, which visit may lower, are left out.
template <TriangleLayout layout = TriangleLayout::expanded>
struct ThroughHierarchy {
  static constexpr TriangleLayout kLayout = layout;
  static constexpr bool kOnlyOne = false;
  using Sides = BothSides;
  using Shadows = ThroughHierarchy;  // what shadow rays go through

  struct Postponed {
    uint32_t node;
    float enter;
  };

#if defined(__CUDACC__)
#pragma nv_diagnostic push
#pragma nv_diag_suppress 549  // "stack" used before its value is set: nvcc does not see that only what is open is read
#endif
  template <class Visit>
  KD_HD static void for_each(const SceneView& scene, const Ray& ray, const double& t_limit, const Visit& visit) {
    if (scene.instance_count == 0) return;
    HierarchyNode node = load(scene.hierarchy);
    const BoxTest<float> test = box_test(ray, node);
    float limit = rounded_up(t_limit);
    if (!test.pass(node, limit).passes()) return;
    Postponed stack[kMaxHierarchyDepth];
    int open = 0;
    const auto resume = [&] {
      do {
        if (open == 0) return false;
        --open;
      } while (stack[open].enter > limit);
      node = load(scene.hierarchy + stack[open].node);
      return true;
    };
    while (true) {
      // On a GPU all lanes of a warp look for an instance, and then visit theirs together.
      while (!node.is_leaf) {
        const uint32_t first = node.first;
        const HierarchyNode a = load(scene.hierarchy + first), b = load(scene.hierarchy + first + 1);
        const Passage<float> to_a = test.pass(a, limit), to_b = test.pass(b, limit);
        const bool a_first = to_a.passes() && (!to_b.passes() || to_a.enter <= to_b.enter);
        if (to_a.passes() && to_b.passes())
          stack[open++] = a_first ? Postponed{first + 1, to_b.enter} : Postponed{first, to_a.enter};
        if (to_a.passes() || to_b.passes()) {
          node = a_first ? a : b;
        } else if (!resume()) {
          return;
        }
      }
      if (!visit(node.first)) return;
      limit = rounded_up(t_limit);
      if (!resume()) return;
    }
  }
#if defined(__CUDACC__)
#pragma nv_diagnostic pop
#endif
};

/// For scenes of one instance, which need no hierarchy; nor, on a GPU, the registers for one.
template <TriangleLayout layout = TriangleLayout::expanded>
struct OnlyInstance {
  static constexpr TriangleLayout kLayout = layout;
  static constexpr bool kOnlyOne = true;
  using Sides = BothSides;
  using Shadows = OnlyInstance;

  template <class Visit>
  KD_HD KD_INLINE static void for_each(const SceneView&, const Ray&, const double&, const Visit& visit) {
    visit(0);
  }
};

/// For scenes with instances that show their fronts alone: kernels of their own, so that others pay nothing for it.
template <TriangleLayout layout = TriangleLayout::expanded>
struct ThroughOneSided : ThroughHierarchy<layout> {
  using Sides = SidesAsAsked;
};

namespace detail {

/// Takes the ray, or a packet's, into the instance's lattice; false if it does not pass the object's box.
template <class RayType, class LatticeRayType>
KD_HD KD_INLINE auto enter_instance(const SceneView& scene, uint32_t index, const RayType& ray,
                                    LatticeRayType& lattice_ray) {
  const InstanceView& instance = scene.instances[index];
  return snap_ray(instance.to_lattice.apply_point(ray.origin), instance.to_lattice.apply_vector(ray.direction),
                  ray.t_min, ray.t_max, scene.objects[instance.object].tree.bits, lattice_ray);
}

/// The distance in the lattice of `t_limit`, rounded up.
template <class LatticeRayType>
KD_HD KD_INLINE auto limit_in_lattice(const LatticeRayType& ray, typename LatticeRayType::Double t_limit) {
  using Double = typename LatticeRayType::Double;
  return to_float(min_of((t_limit - ray.t_base) / ray.t_scale, Double(1e30))) * (1 + 0x1p-20f);
}

}  // namespace detail

/// The nearest hit of a ray in the scene. `counter` hears the steps that it takes within objects.
template <class Instances, class Counter>
KD_HD inline SurfaceHit closest_hit(const SceneView& scene, const Ray& ray, Counter& counter) {
  SurfaceHit best;
  double t_limit = ray.t_max;
  Instances::for_each(scene, ray, t_limit, [&](uint32_t index) {
    LatticeRay lattice_ray;
    if (!detail::enter_instance(scene, index, ray, lattice_ray)) return true;
    const float s_limit = best.instance == kNone ? lattice_ray.s_max : detail::limit_in_lattice(lattice_ray, t_limit);
    if (s_limit < 0) return true;
    const ObjectView& object = scene.objects[scene.instances[index].object].tree;
    const uint32_t triangle = Instances::Sides::with_test(scene, index, [&]<class Test>() {
      return traverse<RayMode::closest, Test, Instances::kLayout>(object, lattice_ray, s_limit, kNoTriangle, counter);
    });
    if (triangle == kNoTriangle) return true;
    const TriangleHit hit = ExactTest(lattice_ray).locate(object.triangle<Instances::kLayout>(triangle));
    reduce(best, {lattice_ray.t_at(hit.s), hit.u, hit.v, index, triangle});
    t_limit = best.t;
    return true;
  });
  return best;
}

template <class Instances = ThroughHierarchy<>>
KD_HD KD_INLINE SurfaceHit closest_hit(const SceneView& scene, const Ray& ray) {
  NoCounter counter;
  return closest_hit<Instances>(scene, ray, counter);
}

/// Whether the ray meets anything but `excluded`.
template <class Instances = ThroughHierarchy<>>
KD_HD inline bool any_hit(const SceneView& scene, const Ray& ray, Excluded excluded) {
  bool met = false;
  Instances::for_each(scene, ray, ray.t_max, [&](uint32_t index) {
    LatticeRay lattice_ray;
    if (!detail::enter_instance(scene, index, ray, lattice_ray)) return true;
    const ObjectView& object = scene.objects[scene.instances[index].object].tree;
    const uint32_t own = excluded.instance == index ? excluded.triangle : kNoTriangle;
    NoCounter counter;
    met = traverse<RayMode::any, ExactTest, Instances::kLayout>(object, lattice_ray, lattice_ray.s_max, own, counter) !=
          kNoTriangle;
    return !met;
  });
  return met;
}

/// Returns whether the pixel's ray hit something.
template <class Instances>
struct ObjectIntersection {
  static constexpr const char* kName = "object intersection";
  FrameView frame;

  KD_HD uint32_t operator()(uint32_t pixel) const {
    const SurfaceHit hit = closest_hit<Instances>(frame.scene, primary_ray(frame, pixel));
    frame.hits[pixel] = hit;
    return hit.instance != kNone;
  }
};

/// The same of a pixel's centre, where that is none of its samples: for AOVs alone, and counted nowhere.
template <class Instances>
struct CentreIntersection : ObjectIntersection<Instances> {};

}  // namespace kd::render
