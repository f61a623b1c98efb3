// Primary hits of one form of a mesh against those on the source mesh in double precision.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pareto/render.h"

namespace kd::bench {

/// Of the sizes of some errors; all 0 if there are none.
struct Spread {
  double median = 0;
  double p99 = 0;  // 99 % are not larger
  double rms = 0;
  double max = 0;
};
Spread spread(std::vector<double> sizes);

struct HitErrors {
  uint64_t pixels = 0;
  uint64_t reference_hits = 0;
  uint64_t missed = 0;      // pixels that show nothing and should
  uint64_t false_hits = 0;  // pixels that show something and should not
  uint64_t wrong = 0;       // another primitive than the reference's, in another place
  uint64_t coincident = 0;  // another primitive, but on the source mesh the ray meets both in one place
  uint64_t same = 0;        // the same primitive: what follows is over these
  Spread depth;             // model units along the ray
  Spread relative_depth;    // over the distance from the camera
  Spread normal;            // degrees between the geometric normals, both facing the ray
};

/// The source's corners by source primitive, and the form's.
struct TwoSurfaces {
  CornersOf reference, form;
};

/// Two hits count as in one place if their distances along the ray agree to what float32 keeps of the coordinates
/// involved, 2^-22 of the distance and of the camera's position.
HitErrors hit_errors(const View& view, const ReferenceRender& reference, std::span<const render::HitRecord> hits,
                     const TwoSurfaces& surfaces);

}  // namespace kd::bench
