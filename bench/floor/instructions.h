// Instructions that a ray costs in the CUDA trace kernel, part by part and pipe by pipe, counted in its SASS.
//
// Counted by scripts/count_sass.py in what nvcc 13.0 makes of cuda_trace.cu for sm_90, along the way that most rays
// take: a ray that starts inside the object's cube, divisions without their special cases, a triangle whose filter is
// certain, another cell on the stack after a leaf. All other ways are longer, so a floor made of these counts is one.
// After a change of the kernel they are to be counted again: `cuobjdump -sass` of its object file, the
// script without addresses lists the branches, and the parts are
//   outside      from the entry to the branch that asks whether the ray starts inside the cube
//   setup        on to the first node: that branch, snapping, the loads of what the loops keep
//   step         the inner loop, from its head to the branch back
//   leaf         from that loop's end to the first reference; from the last one over the stack to the next cell
//   triangle     from the reference's load to the branch after the filter, and the end of the triangles' loop
//   in_double    the weights, the distance, its comparison; without exact signs
//   hit, miss    from the end of traversal to the end of the kernel
#pragma once

#include <cstdint>

#include "core/ray.h"

namespace kd::bench::floors {

/// Instructions: all that are issued, and of them those of pipes which take fewer than one a cycle.
struct Cost {
  double issued = 0;
  double alu = 0;      // integers, logic, comparisons, selections, minima: half as many a cycle on Hopper
  double fp64 = 0;     // half as many
  double convert = 0;  // to and from double, and reciprocals: an eighth

  constexpr Cost operator+(const Cost& c) const {
    return {issued + c.issued, alu + c.alu, fp64 + c.fp64, convert + c.convert};
  }
  constexpr Cost operator*(double times) const { return {issued * times, alu * times, fp64 * times, convert * times}; }
};

struct KernelCosts {
  Cost outside;  // a ray that never enters the cube; at least this
  Cost setup;
  Cost step;
  Cost leaf;
  Cost triangle;
  Cost in_double;  // on top of `triangle`
  Cost hit;
  Cost miss;
};

constexpr KernelCosts kClosestCosts{{105, 17, 35, 9}, {249, 63, 74, 28}, {32, 22, 0, 0},    {25, 6, 0, 0},
                                    {55, 22, 0, 0},   {58, 2, 32, 13},   {100, 18, 32, 15}, {17, 2, 0, 0}};
constexpr KernelCosts kAnyCosts{{100, 17, 35, 9}, {246, 65, 75, 27}, {32, 22, 0, 0},   {28, 6, 0, 0},
                                {55, 22, 0, 0},   {49, 0, 30, 13},   {98, 18, 32, 15}, {16, 2, 0, 0}};

constexpr const KernelCosts& costs_of(RayMode mode) { return mode == RayMode::any ? kAnyCosts : kClosestCosts; }

}  // namespace kd::bench::floors
