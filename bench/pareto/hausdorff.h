// How far a form's surface lies from the source's: the Hausdorff distance, sampled.
#pragma once

#include <cstdint>
#include <functional>

#include "pareto/reference_tracer.h"

namespace kd::bench {

struct Hausdorff {
  double to_form = 0;    // the farthest a sample of the source lies from the form; model units
  double to_source = 0;  // the farthest a sample of the form lies from the source
  uint64_t samples = 0;  // of both

  double distance() const { return to_form > to_source ? to_form : to_source; }
};

/// A surface to sample, and the triangle of the other one that stands for triangle i, or null if it was dropped: a
/// point near every sample, with which the search begins.
struct SampledSurface {
  const ReferenceTracer& surface;
  std::function<const Corners*(uint32_t)> counterpart;
};

/// Samples are all corners and the centres of n^2 equal parts of each triangle, n the least with which no part is
/// larger than the surface's area over `parts`; so the largest distances may be missed, but not in large triangles.
/// A triangle whose corners all move by at most x has no point that moves further; while none is dropped, the largest
/// displacement of a vertex bounds this.
Hausdorff hausdorff(const SampledSurface& source, const SampledSurface& form, uint64_t parts);

}  // namespace kd::bench
