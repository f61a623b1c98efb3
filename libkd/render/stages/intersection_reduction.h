// Intersection reduction: of a ray's hits in all instances, the nearest.
//
// The paper writes one intersection for each ray and object and reduces them afterwards. Here the reduction runs as the
// hits come, so none but the nearest is stored; the order they come in does not matter, because the comparison is
// total.
#pragma once

#include "render/view.h"

namespace kd::render {

/// Nearer first; at the same distance the instance that the scene names first, then the triangle.
KD_HD KD_INLINE bool nearer(const SurfaceHit& a, const SurfaceHit& b) {
  if (a.t != b.t) return a.t < b.t;
  return a.instance != b.instance ? a.instance < b.instance : a.triangle < b.triangle;
}

KD_HD KD_INLINE void reduce(SurfaceHit& best, const SurfaceHit& hit) {
  if (best.instance == kNone || nearer(hit, best)) best = hit;
}

}  // namespace kd::render
