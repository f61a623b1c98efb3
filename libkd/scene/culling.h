// Culling: which instances a picture's rays can meet. Those from the camera lie in a pyramid; those to a light lie
// between what the camera sees and the light.
//
// Boxes are tested against what holds all these rays, so more may be kept than is met, and nothing that is met is left
// out: bounds are wider than what rounding, the snapping of rays to lattices and the lift of shadow rays
// (core/lattice_ray.h, render/stages/surface.h) add up to.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/instances.h"
#include "scene/scene.h"

namespace kd::scene {

/// Of the film, what is rendered, in pixels; not empty.
struct FilmPart {
  uint32_t column = 0;
  uint32_t row = 0;
  uint32_t width = 0;
  uint32_t height = 0;
};

/// What the rays of one frame start from and go to.
struct View {
  Camera camera;  // without keys, as the lights
  FilmSize film;
  FilmPart part;
  std::vector<Light> lights;
};

/// Sets met[i] to 1 if a ray may meet instances[i], and leaves it as it is if none can. `lattices`: one an object.
void mark_met(const View& view, std::span<const Lattice> lattices, std::span<const Instance> instances,
              std::span<uint8_t> met);

}  // namespace kd::scene
