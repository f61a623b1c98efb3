// One mesh at one number of bits, as a stress run sees it on the host or on a device: the object as the product
// traverses it, the same triangles as integers for the oracle, and what rays are aimed at.
#pragma once

#include "core/object_view.h"
#include "render/view.h"

namespace kd::stress {

/// A triangle in integers, and its number in the object.
struct OracleTriangle {
  Vec3u a, b, c;  // lattice coordinates
  uint32_t index = 0;
};

/// Lattice coordinates, both ends included.
struct OracleBox {
  Vec3u lo, hi;
};

/// Every triangle has a box, as they lie in memory; every kOracleFan boxes have one again; and so on. The oracle leaves
/// out what lies in a box that the ray's line provably does not touch, in integers.
constexpr uint32_t kOracleFan = 4;
constexpr int kOracleLevels = 17;  // 4^16 = 2^32

struct OracleView {
  const OracleTriangle* triangles = nullptr;
  const uint32_t* place = nullptr;  // number in the object -> index into triangles
  const OracleBox* boxes = nullptr;
  uint32_t triangle_count = 0;
  int levels = 0;                      // level 0: the triangles' own boxes
  uint32_t first[kOracleLevels] = {};  // level -> index of its first box
  uint32_t count[kOracleLevels] = {};

  KD_HD KD_INLINE const OracleTriangle& triangle(uint32_t index) const { return triangles[place[index]]; }
};

/// What is known of a mesh beyond its triangles.
struct CaseTraits {
  bool even = false;    // every line crosses it an even number of times: it is closed
  bool convex = false;  // and no point of it hides another from outside; its faces exactly plane, wound outwards
  bool inside =
      false;  // every point within inside_size of inside_point (maximum norm, lattice steps) is in its interior
  bool sheets = false;  // inside_point lies between two sheets across z, one step apart
  Vec3d inside_point;   // lattice space
  Vec3d inside_size;
};

struct CaseView {
  ObjectView object;
  OracleView oracle;
  const Vec3u* vertices = nullptr;
  uint32_t vertex_count = 0;
  uint32_t node_count = 0;
  CaseTraits traits;
  const render::InstanceView* placements = nullptr;  // the mesh placed in scenes: see query.h
  const render::ShadedObjectView* shaded = nullptr;  // the one object that they place

  KD_HD KD_INLINE double top() const { return lattice_max(object.bits); }
  KD_HD KD_INLINE render::SceneView scene() const {
    render::SceneView view;
    view.instances = placements;
    view.objects = shaded;
    return view;
  }
};

}  // namespace kd::stress
