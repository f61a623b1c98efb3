// The scene's hierarchy: built over instances, and kept right while they move.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/hierarchy.h"
#include "scene/instances.h"
#include "sys/huge_array.h"

namespace kd::scene {

/// Nodes of a hierarchy over so many instances: each has a leaf, and inner nodes have two children.
constexpr size_t hierarchy_size(size_t instances) { return instances == 0 ? 0 : 2 * instances - 1; }

/// As build_hierarchy of instances.h, into `nodes`, which has room for all. May throw std::bad_alloc.
void build_hierarchy(std::span<const Instance> instances, std::span<HierarchyNode> nodes);

/// The box of a leaf: holds all that a ray may meet of an instance with this box. That is its object's cube widened by
/// 2^-24 of itself, which is where snapping may take a ray (core/lattice_ray.h), and what placing rounds, 1e-12 of the
/// coordinates; rounded outwards to float32, infinite where it leaves that range.
Box3f leaf_box(const Box3d& box_scene);

/// Refits the boxes above instances that moved, and knows by how much that has made the hierarchy worse.
class Refitter {
 public:
  /// For `nodes` as they were built. May throw std::bad_alloc.
  explicit Refitter(std::span<const HierarchyNode> nodes);

  /// Boxes become what a build would give these nodes: leaves of `moved` and the nodes above them are touched, no
  /// others. `nodes` are those of the constructor, `moved` no instance twice.
  void refit(std::span<HierarchyNode> nodes, std::span<const Instance> instances, std::span<const uint32_t> moved);

  /// The surface of all inner nodes, which is how many of them a ray passes, over what it was when they were built. The
  /// same for any number of threads.
  double growth() const { return static_cast<double>(surface_) / static_cast<double>(built_surface_); }

 private:
  void climb(std::span<HierarchyNode> nodes, uint32_t leaf, int64_t& added);
  int64_t surface(const HierarchyNode& node) const;

  HugeArray<uint32_t> parents_;   // of nodes
  HugeArray<uint32_t> leaves_;    // of instances
  std::vector<uint8_t> pending_;  // children of each node that have yet to be refitted; all 0 between calls
  double unit_ = 1;               // of surface_: 2^-32 of the root's area as built. Whole, so that sums have no order
  int64_t surface_ = 0;
  int64_t built_surface_ = 1;
};

}  // namespace kd::scene
