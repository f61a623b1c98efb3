#include "embree_instances.h"

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "embree_mesh.h"

namespace kd::bench {

namespace {

class Instances final : public EmbreeInstances {
 public:
  explicit Instances(const render::LoadedScene& loaded) : device_(rtcNewDevice(nullptr)) {
    if (!device_) return;
    for (const render::LoadedObject& object : loaded.objects) objects_.push_back(scene_of(object.file.geometry()));
    scene_ = empty_scene();
    for (const scene::Instance& instance : loaded.instances) {
      add(objects_[loaded.object_slots[instance.object]], instance.lattice_to_scene);
    }
    rtcCommitScene(scene_);
  }
  Instances(const Instances&) = delete;
  Instances& operator=(const Instances&) = delete;
  ~Instances() override {
    if (scene_) rtcReleaseScene(scene_);
    for (RTCScene object : objects_) rtcReleaseScene(object);
    if (device_) rtcReleaseDevice(device_);
  }

  int error() const { return static_cast<int>(rtcGetDeviceError(device_)); }

  std::optional<float> closest(const Ray& ray) const override {
    RTCIntersectContext context = asking_for(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
    RTCRayHit query{};
    const Vec3f o = vec_cast<float>(ray.origin), d = vec_cast<float>(ray.direction);
    query.ray = {o.x, o.y, o.z, static_cast<float>(ray.t_min), d.x, d.y, d.z, 0, kEndless, 0xffffffffu, 0, 0};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return query.ray.tfar;
  }

  void closest(const PerRay<Ray>& rays, RaySet set, PerRay<std::optional<float>>& distances) const override {
    RTCIntersectContext context = asking_for(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
    alignas(32) int valid[kPacketRays]{};
    RTCRayHit8 query{};
    for_each_ray(set, [&](size_t i) {
      const Vec3f o = vec_cast<float>(rays[i].origin), d = vec_cast<float>(rays[i].direction);
      valid[i] = -1;
      query.ray.org_x[i] = o.x;
      query.ray.org_y[i] = o.y;
      query.ray.org_z[i] = o.z;
      query.ray.tnear[i] = static_cast<float>(rays[i].t_min);
      query.ray.dir_x[i] = d.x;
      query.ray.dir_y[i] = d.y;
      query.ray.dir_z[i] = d.z;
      query.ray.tfar[i] = kEndless;
      query.ray.mask[i] = 0xffffffffu;
      query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    });
    rtcIntersect8(valid, scene_, &context, &query);
    for_each_ray(set, [&](size_t i) {
      const bool met = query.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
      distances[i] = met ? std::optional(query.ray.tfar[i]) : std::nullopt;
    });
  }

 private:
  static constexpr float kEndless = std::numeric_limits<float>::infinity();

  static RTCIntersectContext asking_for(RTCIntersectContextFlags flags) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = flags;
    return context;
  }

  RTCScene empty_scene() const {
    RTCScene scene = rtcNewScene(device_);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    return scene;
  }

  RTCScene scene_of(const nkd::Geometry& geometry) const {
    const PackedTriangles packed = geometry.packed();
    RTCScene scene = empty_scene();
    attach_mesh(
        device_, scene, geometry.vertex_count(), [&](size_t i) { return packed.position(i); },
        geometry.triangle_count(),
        [&](size_t i) {
          const Vec3u c = packed.corners[i];
          return std::array{c.x, c.y, c.z};
        });
    rtcCommitScene(scene);
    return scene;
  }

  void add(RTCScene object, const Frame& to_scene) {
    RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, object);
    std::array<float, 12> columns;
    const Vec3d parts[] = {to_scene.x_axis, to_scene.y_axis, to_scene.z_axis, to_scene.point};
    for (size_t i = 0; i < 4; ++i) {
      columns[3 * i] = static_cast<float>(parts[i].x);
      columns[3 * i + 1] = static_cast<float>(parts[i].y);
      columns[3 * i + 2] = static_cast<float>(parts[i].z);
    }
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
    rtcCommitGeometry(instance);
    rtcAttachGeometry(scene_, instance);
    rtcReleaseGeometry(instance);
  }

  RTCDevice device_;
  std::vector<RTCScene> objects_;
  RTCScene scene_ = nullptr;
};

}  // namespace

Result<std::unique_ptr<EmbreeInstances>> embree_instances(const render::LoadedScene& scene) {
  auto peer = std::make_unique<Instances>(scene);
  if (const int error = peer->error(); error != RTC_ERROR_NONE)
    return Error{ErrorClass::device, "Embree", "failed with error " + std::to_string(error)};
  return std::unique_ptr<EmbreeInstances>(std::move(peer));
}

}  // namespace kd::bench
