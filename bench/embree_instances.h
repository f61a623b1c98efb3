// A loaded scene as Embree has it, each object a scene of its own and instanced: the peer that tracing instances is
// compared with. A build of kdbench without Embree 3 says so.
#pragma once

#include <memory>
#include <optional>

#include "core/ray.h"
#include "render/load.h"
#include "sys/result.h"

namespace kd::bench {

struct InstanceHit {
  float t = 0;
  uint32_t instance = 0;
};

class EmbreeInstances {
 public:
  virtual ~EmbreeInstances() = default;
  /// The nearest hit, in float32. From any thread.
  virtual std::optional<InstanceHit> closest(const Ray& ray) const = 0;
};

/// Vertices are lattice coordinates, which are exact in float32; instances take them to scene space. Triangles robust,
/// built at high quality. ErrorClass::device.
Result<std::unique_ptr<EmbreeInstances>> embree_instances(const render::LoadedScene& scene);

}  // namespace kd::bench
