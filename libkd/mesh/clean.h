// Drops the triangles that are no surface, or the same surface again, and says how many and where the first was.
#pragma once

#include <cstdint>

#include "mesh/mesh.h"

namespace kd::mesh {

struct FaceFault {
  uint64_t count = 0;
  uint32_t first = kNoIndex;  // the source primitive of the first one

  friend bool operator==(const FaceFault&, const FaceFault&) = default;
};

/// A triangle is counted once, under the first fault that it has.
struct CleanReport {
  FaceFault non_finite;  // dropped: a coordinate that is NaN or infinite
  FaceFault degenerate;  // dropped: two corners in one place, or an area of exactly 0 in double precision
  FaceFault duplicate;   // dropped: the same three places in the same cyclic order as an earlier triangle
  FaceFault opposite;    // kept: the same three places as an earlier one, the other way round (a thin sheet's back)
};

/// Drops triangles from all the per-triangle arrays; the order of the rest stays, and no vertex is removed. Places are
/// compared by value, not by index. Coordinates of any magnitude are judged alike. O(N log N), on one core.
CleanReport clean(Mesh& mesh);

}  // namespace kd::mesh
