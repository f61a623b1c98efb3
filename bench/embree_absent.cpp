#include "embree_build.h"
#include "embree_instances.h"

namespace kd::bench {

namespace {

Error absent() { return {ErrorClass::device, "Embree", "Embree 3 was not found when kdbench was configured"}; }

}  // namespace

Result<std::string> embree_version() { return absent(); }

Result<double> embree_build_seconds(std::span<const Vec3f>, std::span<const std::array<uint32_t, 3>>, EmbreeQuality) {
  return absent();
}

Result<std::unique_ptr<EmbreeInstances>> embree_instances(const render::LoadedScene&) { return absent(); }

}  // namespace kd::bench
