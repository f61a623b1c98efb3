// What the usual float32 tracer makes of depth: one that leaves vertices and rays in model space, in float32. The
// project's own float32 baselines do better than that, as they take a ray in double to where it enters the object's box
// and measure distances from there.
#pragma once

#include "pareto/hit_errors.h"

namespace kd::bench {

/// Depth errors, model units, where the test accepts the triangle that the reference hits.
struct ModelSpaceDepth {
  Spread moller_trumbore;
  Spread woop;
};

/// No traversal, only the tests: on the reference's triangles, corners rounded to float32, and the rays as they are.
ModelSpaceDepth model_space_depth(const View& view, const ReferenceRender& reference, const CornersOf& corners);

}  // namespace kd::bench
