#include "embree_build.h"

#include <fmt/format.h>

#include "embree_mesh.h"
#include "sys/timer.h"

namespace kd::bench {

namespace {

Error embree_error(RTCDevice device) {
  return {ErrorClass::device, "Embree",
          fmt::format("failed with error {}", static_cast<int>(rtcGetDeviceError(device)))};
}

/// A device and a scene of its own. While one lives, Embree may hold all of oneTBB to the device's one thread.
class Scene {
 public:
  explicit Scene(EmbreeQuality quality) : device_(rtcNewDevice("threads=1")) {
    if (!device_) return;
    scene_ = rtcNewScene(device_);
    rtcSetSceneBuildQuality(scene_, quality == EmbreeQuality::high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM);
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  ~Scene() {
    if (scene_) rtcReleaseScene(scene_);
    if (device_) rtcReleaseDevice(device_);
  }

  /// Copies the mesh into buffers of Embree's.
  bool fill(std::span<const Vec3f> vertices, std::span<const std::array<uint32_t, 3>> triangles) {
    if (!device_) return false;
    return attach_mesh(
        device_, scene_, vertices.size(), [&](size_t i) { return vertices[i]; }, triangles.size(),
        [&](size_t i) { return triangles[i]; });
  }
  bool commit() {
    rtcCommitScene(scene_);
    return rtcGetDeviceError(device_) == RTC_ERROR_NONE;
  }
  Error error() const { return embree_error(device_); }

 private:
  RTCDevice device_;
  RTCScene scene_ = nullptr;
};

}  // namespace

Result<std::string> embree_version() { return std::string("Embree " RTC_VERSION_STRING); }

Result<double> embree_build_seconds(std::span<const Vec3f> vertices, std::span<const std::array<uint32_t, 3>> triangles,
                                    EmbreeQuality quality) {
  Scene scene(quality);
  if (!scene.fill(vertices, triangles)) return scene.error();
  Timer timer;
  if (!scene.commit()) return scene.error();
  return timer.seconds();
}

}  // namespace kd::bench
