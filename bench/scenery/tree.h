// Trees: trunk, branches, twigs and leaves, grown from a species and a seed.
#pragma once

#include "scenery/obj_mesh.h"

namespace kd::bench::scenery {

/// Of trees whose branches fork. Lengths in metres, shares in [0, 1].
struct Species {
  double height = 15;
  double radius = 0.3;  // of the trunk's foot
  double bare = 0.25;   // share of the trunk below the first branch
  int branches = 16;    // of the trunk
  double reach = 0.35;  // the longest branch, as a share of the height
  double rise = 0.5;    // how steeply branches climb; < 0: they hang
  int forks = 9;        // of a branch
  int twigs = 7;        // of a fork
  int leaves = 18;      // of a twig
  double leaf_length = 0.2;
  double leaf_width = 0.12;
  Stuff bark = Stuff::bark;
  Stuff foliage = Stuff::beech;
};

ObjMesh grow_tree(const Species& species, uint64_t seed);

/// Several stems from one root.
ObjMesh grow_shrub(const Species& species, int stems, uint64_t seed);

/// A straight trunk with whorls of hanging branches under sprays of needles.
ObjMesh grow_spruce(double height, uint64_t seed);

}  // namespace kd::bench::scenery
