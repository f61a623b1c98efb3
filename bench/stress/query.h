// What a stress run asks of a ray: its class, the ray itself, and what must come of it.
#pragma once

#include "core/traversal.h"

namespace kd::stress {

enum class RayClass : uint32_t {
  vertices,   // at every vertex
  edges,      // at every edge's midpoint
  faces,      // at face interiors
  exact,      // with slopes that the ray's grid holds, so that the snapped ray meets the vertex or midpoint exactly
  planes,     // lying in a split plane
  grid,       // parallel to an axis, through lattice points
  grazing,    // in a triangle's plane, or a hair's breadth off it
  along,      // along an edge, or from vertex to vertex and past it
  near_axis,  // parallel to an axis but for 10^-7 and less
  far_away,   // from 10^3 to 10^9 cubes away
  segments,   // ending at, just before or just after what they are aimed at
  inside,     // from inside a closed mesh, at each vertex and edge in turn: a miss is a leak
  model,      // float32 rays of model space, as kdbench trace reads them
  frames,     // through far, tiny, huge, mirrored, sheared and uneven frames
  shadow,     // shadow rays as the renderer makes them: no triangle is shadowed by itself or its plane
  contact,    // shadow rays from a sheet that touches another but for one lattice step
};
constexpr uint32_t kRayClasses = 16;

/// What must come of a ray whatever the oracle says.
enum class Demand : uint32_t {
  none,
  hit,       // it starts inside a closed mesh
  even,      // it starts outside one: it crosses an even number of times
  lit,       // it leaves a convex body
  occluded,  // another sheet is above
  lifted,    // it starts on `excluded`, whose plane therefore must not shadow it
};

/// A ray in lattice space as it comes to snap_ray.
struct Query {
  Vec3d origin, direction;
  double t_min = 0, t_max = 1e300;
  uint32_t excluded = kNoTriangle;
  Demand demand = Demand::none;
};

/// Of CaseView::placements: model space, then one row of kSceneFrames after the other.
constexpr uint32_t kSceneFrames = 7;

/// Bits up to which a shadow ray's start, two grid steps up, is nearer than the next lattice plane.
constexpr int kContactBits = 22;

}  // namespace kd::stress
