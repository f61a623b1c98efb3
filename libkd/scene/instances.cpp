#include "scene/instances.h"

#include <new>

#include "scene/expansion.h"

namespace kd::scene {

std::vector<Material> override_materials(const Scene& scene) {
  std::vector<Material> materials;
  for (const Character& character : scene.characters) {
    for (const Part& part : character.parts) {
      if (part.material) materials.push_back(*part.material);
    }
  }
  return materials;
}

Result<std::vector<Instance>> place_instances(const Scene& scene, std::span<const Lattice> lattices, double frame) {
  try {
    const auto expansion = Expansion::of(scene, lattices);
    if (!expansion) return expansion.error();
    std::vector<Instance> instances(expansion->count());
    if (const auto placed = expansion->place_all(frame, instances); !placed) return placed.error();
    return instances;
  } catch (const std::bad_alloc&) {
    return Error{ErrorClass::resource, scene.path, "not enough memory for the scene's instances"};
  }
}

}  // namespace kd::scene
