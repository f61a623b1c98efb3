// A loaded scene as Embree has it, each object a scene of its own and instanced: the peer that tracing instances is
// compared with. A build of kdbench without Embree 3 says so.
#pragma once

#include <memory>
#include <optional>

#include "core/packet.h"
#include "core/ray.h"
#include "render/load.h"
#include "sys/result.h"

namespace kd::bench {

class EmbreeInstances {
 public:
  virtual ~EmbreeInstances() = default;
  /// Distance of the nearest hit. From any thread.
  virtual std::optional<float> closest(const Ray& ray) const = 0;
  /// The same of the rays of a packet, as rays that belong together.
  virtual void closest(const PerRay<Ray>& rays, RaySet set, PerRay<std::optional<float>>& distances) const = 0;
};

/// Vertices are lattice coordinates, which are exact in float32; instances take them to scene space. Triangles robust,
/// built at high quality. ErrorClass::device.
Result<std::unique_ptr<EmbreeInstances>> embree_instances(const render::LoadedScene& scene);

}  // namespace kd::bench
