// What rays have to do in an object's tree, counted on the CPU: by each ray, and by warps of 32 rays in lockstep.
#pragma once

#include <span>

#include "floor/instructions.h"
#include "nkd/object_file.h"
#include "render/trace.h"

namespace kd::bench::floors {

/// How often the parts of the kernel run: by a ray, or by a warp for any of its rays.
struct Work {
  uint64_t outside = 0;
  uint64_t setups = 0;
  uint64_t steps = 0;
  uint64_t leaves = 0;
  uint64_t triangles = 0;
  uint64_t in_double = 0;
  uint64_t hits = 0;
  uint64_t misses = 0;

  Work& operator+=(const Work& w);
  Cost cost(const KernelCosts& costs) const;
};

struct RayWork {
  Work rays;
  /// 32 consecutive rays go together: to the next leaf as many steps as the one that takes most, there as many
  /// triangles as the one that has most, in double if one of them is. What a GPU does if its warps come together again
  /// at the end of every loop.
  Work warps;
};

/// The exact test, on as many threads as kd::ThreadLimit allows.
RayWork count_work(const nkd::ObjectFile& object, std::span<const render::RayRecord> rays, RayMode mode);

/// What a ray's part of the work loads, in loads of one thread: nodes and references of up to 8 bytes, triangles in
/// pieces of 16. Stack entries, which stay in the L1 cache, are left out.
struct Loads {
  uint64_t of_8 = 0;
  uint64_t of_16 = 0;
  uint64_t bytes = 0;     // of these
  uint64_t streamed = 0;  // bytes: the rays in, the hits out
};
Loads loads_of(const Work& rays);

}  // namespace kd::bench::floors
