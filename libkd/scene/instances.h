// Instances: every object that parts of shown characters place, placed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/box.h"
#include "core/frame.h"
#include "core/hierarchy.h"
#include "core/lattice.h"
#include "scene/motion.h"
#include "scene/scene.h"
#include "sys/result.h"

namespace kd::scene {

constexpr uint32_t kOwnMaterials = 0xffffffffu;

struct Instance {
  uint32_t object = 0;                // index into Scene::objects
  uint32_t material = kOwnMaterials;  // index into override_materials(), instead of the object's own
  Frame lattice_to_scene;
  InverseFrame scene_to_lattice;
  Box3d box_scene;  // around the object's box as placed
};

/// The materials of all parts that have one, in the order of the scene file.
std::vector<Material> override_materials(const Scene& scene);

/// The instances at a frame, in the order of the scene file: of every character that is shown, of each of its parts,
/// and in the place of a part that places a character, those of that character. `lattices`: one an object; those of
/// objects that no part places are not read. ErrorClass::scene, with the part's line, if a placement is singular or
/// leaves the range of double, or for a NestingFault (nesting.h); ErrorClass::resource if there is no memory for them.
Result<std::vector<Instance>> place_instances(const Scene& scene, std::span<const Lattice> lattices,
                                              double frame = kDefaultFrame);

/// A tree of boxes over the instances: node 0 is the root, a leaf holds one instance, the two children of a node lie
/// side by side and behind it. Split by the surface area heuristic over box centres, in bins; no deeper than
/// kMaxHierarchyDepth. Empty for no instances. Boxes hold all that rays may meet of their instances, so which of them
/// there are decides nothing but time. The same nodes for any number of threads. May throw std::bad_alloc.
std::vector<HierarchyNode> build_hierarchy(std::span<const Instance> instances);

}  // namespace kd::scene
