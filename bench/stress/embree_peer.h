// Embree 3 beside us: the same triangles and the same snapped rays, in lattice coordinates, which float32 holds
// exactly. A build without Embree has no peer.
#pragma once

#include <memory>

#include "stress/run.h"

namespace kd::stress {

/// Two scenes over the case's triangles, one with RTC_SCENE_FLAG_ROBUST and one without, high quality. Null without
/// Embree. ErrorClass::device.
Result<std::unique_ptr<Peer>> embree_peer(const StressCase& stress_case);

}  // namespace kd::stress
