// Building Embree's BVH over a mesh, the peer that builds are compared with. A build of kdbench without Embree 3 says
// so.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "core/vec.h"
#include "sys/result.h"

namespace kd::bench {

enum class EmbreeQuality { medium, high };

/// "Embree 3.13.5"; ErrorClass::device, with the reason, if there is none.
Result<std::string> embree_version();

/// Seconds from vertices and corners in memory to a committed scene, on one thread. ErrorClass::device.
Result<double> embree_build_seconds(std::span<const Vec3f> vertices, std::span<const std::array<uint32_t, 3>> triangles,
                                    EmbreeQuality quality);

}  // namespace kd::bench
