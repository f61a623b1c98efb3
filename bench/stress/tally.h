// What a stress run counts.
#pragma once

#include <cstdint>

#include "core/platform.h"

namespace kd::stress {

/// What can be wrong with one ray, in the order in which it is looked for; the first that is found is counted.
enum class Fault : uint32_t {
  none,
  unsnapped,     // it passes through the cube, and snap_ray said no
  off_grid,      // the snapped ray is not on its grids
  displaced,     // it was moved further than the stated bound
  test_missed,   // the triangle test missed a triangle that the ray crosses
  test_doubled,  // the triangle test met a triangle that the ray does not cross
  test_off,      // distance or weights are further off than the stated bound
  closest_none,  // traversal found nothing where there is something
  closest_off,   // it found a triangle that the ray does not meet there
  closest_far,   // it found another triangle than the nearest
  any_none,      // a shadow ray passed through
  any_off,       // a shadow ray met what is not there
  leak,          // a ray left a closed mesh
  odd,           // a closed mesh was crossed an odd number of times
  acne,          // a surface shadowed itself
  contact_lost,  // a gap of one lattice step was not seen
  packet_off,    // in a packet with others the ray met something else than alone
};
constexpr uint32_t kFaults = 17;

enum class Harm : uint32_t { none, miss, double_count, mismatch };

KD_HD KD_INLINE Harm harm_of(Fault fault) {
  switch (fault) {
    case Fault::none:
      return Harm::none;
    case Fault::unsnapped:
    case Fault::test_missed:
    case Fault::closest_none:
    case Fault::any_none:
    case Fault::leak:
    case Fault::contact_lost:
      return Harm::miss;
    case Fault::test_doubled:
    case Fault::odd:
      return Harm::double_count;
    default:
      return Harm::mismatch;
  }
}

/// Counters, all of them sums; as an array, so that a device can add them one by one.
enum Count : uint32_t {
  kRays,     // drawn
  kSnapped,  // of these, rays that have a point in the cube and so were traced
  kHits,     // of these, rays that meet something, by the oracle
  kTies,     // of these, rays that meet an edge or a vertex exactly
  kPlain,    // rays whose oracle looked at every triangle; for the others it left out far boxes
  kMisses,
  kDoubleCounts,
  kMismatches,
  kTriangleTests,  // that traversal made for the nearest hits
  kDoubleTests,    // of these, such as the float filter left undecided
  kExactTests,     // triangles that the oracle decided
  kPeerRays,       // rays given to the peers, too
  kRobustMisses,   // rays that meet something, by the oracle, and that Embree (robust) lost
  kDefaultMisses,  // the same, Embree (default)
  kRobustFalse,    // rays that meet nothing, by the oracle, and for which Embree found something
  kDefaultFalse,
  kCounts
};

struct Tally {
  uint64_t counts[kCounts] = {};
  // The largest displacements of a snapped ray across its axis, in grid steps: where it starts, and where it leaves.
  double moved_near = 0;
  double moved_far = 0;

  KD_HD KD_INLINE uint64_t operator[](Count c) const { return counts[c]; }
  KD_HD KD_INLINE void add(Count c, uint64_t n = 1) { counts[c] += n; }
  KD_HD KD_INLINE void add(const Tally& other) {
    for (uint32_t i = 0; i < kCounts; ++i) counts[i] += other.counts[i];
    moved_near = moved_near > other.moved_near ? moved_near : other.moved_near;
    moved_far = moved_far > other.moved_far ? moved_far : other.moved_far;
  }
  KD_HD KD_INLINE uint64_t faults() const { return counts[kMisses] + counts[kDoubleCounts] + counts[kMismatches]; }
};

/// A ray that failed, so that it can be replayed.
struct Failure {
  uint64_t index = 0;
  Fault fault = Fault::none;
};
constexpr uint32_t kMostFailures = 8;  // that one job records

}  // namespace kd::stress
