// The ground: a valley along -z between wooded slopes, with a path on its floor. Metres; the eye stands near the
// origin, on a knoll.
#pragma once

#include "scenery/obj_mesh.h"

namespace kd::bench::scenery {

class Terrain {
 public:
  explicit Terrain(uint64_t seed) : seed_(seed) {}

  double height(double x, double z) const;
  /// Where the path crosses this z.
  double path(double z) const;

  /// The ground over [-half, half] x [near - 2 half, near], in at most `cells` x `cells` quads.
  ObjMesh mesh(double half, double near, int cells) const;
  /// The path as a ribbon on the ground, from z = near to far.
  ObjMesh path_mesh(double near, double far) const;

 private:
  Vec3d normal(double x, double z) const;

  uint64_t seed_;
};

}  // namespace kd::bench::scenery
