// Rays at vertices and edges, and how many triangles around them a triangle test lets each ray meet: it should be one.
//
// The oracle needs no arithmetic of the tests' own. A vertex whose triangles close a ring around it, or an edge of two
// triangles, all facing the camera or all facing away: seen along the ray they tile a polygon around the point aimed
// at. If the point is clear of the polygon's border by more than rounding may move a ray, then every ray aimed at it
// crosses exactly one of them, wherever in the polygon rounding leaves it. No accepted triangle is a miss, two or more
// are a surface counted twice.
//
// Targets are chosen on the source mesh and judged again on the form under test, in double: where quantising dropped or
// turned a triangle of the ring, or made it too small to be clear, the form has no such target.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "mesh/mesh.h"
#include "object_triangles.h"
#include "render/trace.h"

namespace kd::bench {

/// One triangle around a target, and at which of its corners the target is: the vertex, or where the edge begins.
struct StarTriangle {
  uint32_t primitive = 0;  // as the source numbers it
  uint32_t corner = 0;
};

struct Target {
  bool is_edge = false;
  uint32_t first = 0;  // in Targets::stars
  uint32_t count = 0;
};

struct Targets {
  std::vector<Target> all;
  std::vector<StarTriangle> stars;

  std::span<const StarTriangle> star(const Target& t) const { return std::span(stars).subspan(t.first, t.count); }
};

/// Vertices with a closed ring of triangles, oriented alike, and edges of two triangles, likewise. Vertices count as
/// one where their positions are equal.
Targets find_targets(const mesh::Mesh& mesh);

/// A ray at a target, and the distance beyond which it has passed all of the star.
struct AimedRay {
  uint32_t target = 0;
  render::RayRecord ray{};
  double t_behind = 0;
};

/// The rays from `camera` at those targets that are clear on this surface. `corners` gives null for a triangle that the
/// surface lacks.
std::vector<AimedRay> aim(const Targets& targets, Vec3d camera, double diagonal,
                          const std::function<const Corners*(uint32_t primitive)>& corners);

struct FanCounts {
  uint64_t rays = 0;
  uint64_t missed = 0;  // rays that meet no triangle of the star
  uint64_t twice = 0;   // rays that meet more than one
};

/// What `test` makes of the rays, one triangle at a time, on the object's own vertices and with rays prepared as the
/// tracer prepares them. The same on every device, as the arithmetic is.
FanCounts count_fans(const Targets& targets, std::span<const AimedRay> rays, const nkd::ObjectFile& object,
                     render::TriangleTest test);

}  // namespace kd::bench
