// A Phong material as it is stored and shaded: reflectances per colour channel, scene-linear, usually in [0, 1], and
// what the surface gives off by itself.
#pragma once

#include "core/vec.h"

namespace kd {

struct Material {
  Vec3f ambient{0.8f, 0.8f, 0.8f};
  Vec3f diffuse{0.8f, 0.8f, 0.8f};
  Vec3f specular{0, 0, 0};
  float shininess = 1;      // Phong's exponent, >= 0
  Vec3f emission{0, 0, 0};  // radiance, >= 0; lights nothing else

  friend bool operator==(const Material&, const Material&) = default;
};
static_assert(sizeof(Material) == 52);

}  // namespace kd
