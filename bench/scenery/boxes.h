// Flat faces and boxes, in the coordinates of a wall: along it, up, and out of it.
#pragma once

#include "scenery/obj_mesh.h"

namespace kd::bench::scenery {

/// A frame with y up: `foot` is its origin, `along` and `out` are horizontal, of length 1, and along x up = out.
struct WallFrame {
  Vec3d foot;
  Vec3d along{1, 0, 0};
  Vec3d out{0, 0, 1};

  Vec3d at(double a, double y, double o) const { return foot + along * a + Vec3d{0, y, 0} + out * o; }
};

/// The faces of a box, as bits.
enum BoxFaces : unsigned {
  kFront = 1,  // out
  kBack = 2,
  kLeft = 4,  // against along
  kRight = 8,
  kTop = 16,
  kBottom = 32,
  kSides = kLeft | kRight,
  kUpright = kFront | kBack | kSides,
  kStanding = kUpright | kTop,
  kAll = kStanding | kBottom,
};

/// Lowest and highest along, up and out.
struct Extent {
  double a0, a1, y0, y1, o0, o1;
};

/// Four corners in turn, counterclockwise as seen from outside, with flat normals.
inline void add_face(ObjMesh& mesh, Stuff stuff, Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  const auto corner = [&](Vec3d p) { return Corner{mesh.vertex(p), 0}; };
  const Corner first = corner(a), second = corner(b), third = corner(c);
  mesh.quad(stuff, first, second, third, corner(d));
}

inline void add_box(ObjMesh& mesh, Stuff stuff, const WallFrame& f, const Extent& e, unsigned faces) {
  const auto face = [&](BoxFaces which, Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
    if ((faces & which) != 0) add_face(mesh, stuff, a, b, c, d);
  };
  face(kFront, f.at(e.a0, e.y0, e.o1), f.at(e.a1, e.y0, e.o1), f.at(e.a1, e.y1, e.o1), f.at(e.a0, e.y1, e.o1));
  face(kBack, f.at(e.a1, e.y0, e.o0), f.at(e.a0, e.y0, e.o0), f.at(e.a0, e.y1, e.o0), f.at(e.a1, e.y1, e.o0));
  face(kLeft, f.at(e.a0, e.y0, e.o0), f.at(e.a0, e.y0, e.o1), f.at(e.a0, e.y1, e.o1), f.at(e.a0, e.y1, e.o0));
  face(kRight, f.at(e.a1, e.y0, e.o1), f.at(e.a1, e.y0, e.o0), f.at(e.a1, e.y1, e.o0), f.at(e.a1, e.y1, e.o1));
  face(kTop, f.at(e.a0, e.y1, e.o1), f.at(e.a1, e.y1, e.o1), f.at(e.a1, e.y1, e.o0), f.at(e.a0, e.y1, e.o0));
  face(kBottom, f.at(e.a0, e.y0, e.o0), f.at(e.a1, e.y0, e.o0), f.at(e.a1, e.y0, e.o1), f.at(e.a0, e.y0, e.o1));
}

}  // namespace kd::bench::scenery
