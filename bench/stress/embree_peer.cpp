#include "stress/embree_peer.h"

#include <string>

#include "embree_mesh.h"

namespace kd::stress {

namespace {

class EmbreePeer : public Peer {
 public:
  explicit EmbreePeer(const StressCase& c) : device_(rtcNewDevice(nullptr)) {
    if (!device_) return;
    robust_ = scene(c, RTC_SCENE_FLAG_ROBUST);
    plain_ = scene(c, RTC_SCENE_FLAG_NONE);
  }
  EmbreePeer(const EmbreePeer&) = delete;
  EmbreePeer& operator=(const EmbreePeer&) = delete;
  ~EmbreePeer() override {
    if (robust_) rtcReleaseScene(robust_);
    if (plain_) rtcReleaseScene(plain_);
    if (device_) rtcReleaseDevice(device_);
  }

  int error() const { return static_cast<int>(rtcGetDeviceError(device_)); }

  void trace(const Verdict& verdict, Tally& tally) const override {
    const bool robust = hits(robust_, verdict.ray), plain = hits(plain_, verdict.ray);
    tally.add(kPeerRays);
    tally.add(kRobustMisses, verdict.meets && !robust);
    tally.add(kDefaultMisses, verdict.meets && !plain);
    tally.add(kRobustFalse, !verdict.may_meet && robust);
    tally.add(kDefaultFalse, !verdict.may_meet && plain);
  }

 private:
  RTCScene scene(const StressCase& c, RTCSceneFlags flags) {
    RTCScene scene = rtcNewScene(device_);
    rtcSetSceneFlags(scene, flags);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    bench::attach_mesh(
        device_, scene, c.vertices.size(), [&](size_t i) { return vec_cast<float>(c.vertices[i]); }, c.triangles.size(),
        [&](size_t i) { return c.triangles[i]; });
    rtcCommitScene(scene);
    return scene;
  }

  static bool hits(RTCScene scene, const LatticeRay& ray) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    const Vec3f o = ray.origin, d = ray.direction;
    query.ray = {o.x, o.y, o.z, ray.s_min, d.x, d.y, d.z, 0, ray.s_max, 0xffffffffu, 0, 0};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &context, &query);
    return query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }

  RTCDevice device_;
  RTCScene robust_ = nullptr;
  RTCScene plain_ = nullptr;
};

}  // namespace

Result<std::unique_ptr<Peer>> embree_peer(const StressCase& stress_case) {
  auto peer = std::make_unique<EmbreePeer>(stress_case);
  if (const int error = peer->error(); error != RTC_ERROR_NONE)
    return Error{ErrorClass::device, "Embree", "failed with error " + std::to_string(error)};
  return std::unique_ptr<Peer>(std::move(peer));
}

}  // namespace kd::stress
