#include "scene/motion.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "scene/key_segment.h"
#include "scene/rotation.h"

namespace kd::scene {

namespace {

/// Below this sine of the angle between them, `up` counts as parallel to the view direction.
constexpr double kParallelSine = 1e-6;

/// The fields of something with keys at a frame.
template <class Moving>
class Fields {
 public:
  Fields(const Moving& moving, double frame) : moving_(moving), frame_(frame) {}

  template <class Key, class T>
  T operator()(std::optional<T> Key::*field, const T& otherwise) const {
    return value_at(std::span<const Key>(moving_.keys), field, otherwise, frame_,
                    [&](const KeySegment<T>& s) { return interpolate(s, moving_.interpolation); });
  }
  Vec3f operator()(std::optional<Vec3f> LightKey::*field, Vec3f otherwise) const {
    return value_at(std::span<const LightKey>(moving_.keys), field, otherwise, frame_, [&](const KeySegment<Vec3f>& s) {
      const auto to_double = [](Vec3f colour) { return vec_cast<double>(colour); };
      const Vec3d colour = interpolate(s.template mapped<Vec3d>(to_double), moving_.interpolation);
      const auto in_range = [](double c) { return std::clamp(c, 0.0, double{std::numeric_limits<float>::max()}); };
      return vec_cast<float>(Vec3d{in_range(colour.x), in_range(colour.y), in_range(colour.z)});
    });
  }

 private:
  const Moving& moving_;
  double frame_;
};

void extend(std::optional<FrameRange>& range, const auto& keys) {
  if (keys.empty()) return;
  const FrameRange own{keys.front().frame, keys.back().frame};
  range = range ? FrameRange{std::min(range->first, own.first), std::max(range->last, own.last)} : own;
}

}  // namespace

Camera interpolated(const Camera& camera, double frame) {
  const Fields fields(camera, frame);
  return {fields(&CameraKey::position, camera.position), fields(&CameraKey::target, camera.target),
          fields(&CameraKey::up, camera.up), fields(&CameraKey::vertical_fov_degrees, camera.vertical_fov_degrees)};
}

Light interpolated(const Light& light, double frame) {
  const Fields fields(light, frame);
  Light out = light;
  out.position = fields(&LightKey::position, light.position);
  out.direction = fields(&LightKey::direction, light.direction);
  if (out.direction != light.direction) out.direction = normalised(out.direction);
  out.colour = fields(&LightKey::colour, light.colour);
  out.keys.clear();
  return out;
}

TransformPlacement interpolated(const TransformPlacement& placement, double frame) {
  const Fields fields(placement, frame);
  const Rotation rotation = fields(&TransformKey::rotate, Rotation{placement.rotate_axis, placement.rotate_degrees});
  return {fields(&TransformKey::translate, placement.translate), rotation.axis, rotation.degrees,
          fields(&TransformKey::scale, placement.scale)};
}

std::optional<CameraFault> find_fault(const Camera& camera) {
  const Vec3d view = camera.target - camera.position;
  if (view == Vec3d{0, 0, 0}) return CameraFault{"target", "the camera's target is its position: move one of them"};
  if (!is_finite(view)) return CameraFault{"target", "the camera's target is too far from its position"};
  if (!(length(cross(normalised(camera.up), normalised(view))) > kParallelSine)) {
    return CameraFault{"up", "the camera's 'up' is zero or parallel to the way it looks: choose another direction"};
  }
  if (!(camera.vertical_fov_degrees > 0 && camera.vertical_fov_degrees < 180)) {
    return CameraFault{"vertical_fov", "the camera's 'vertical_fov' must be more than 0 and less than 180 degrees"};
  }
  return std::nullopt;
}

Result<Camera> camera_at(const Scene& scene, double frame) {
  const Camera camera = interpolated(scene.camera, frame);
  const auto fault = find_fault(camera);
  if (!fault) return camera;
  return Error{ErrorClass::scene, scene.path, fmt::format("at frame {}: {}", frame, fault->what)};
}

Result<std::vector<Light>> lights_at(const Scene& scene, double frame) {
  std::vector<Light> lights;
  for (const Light& light : scene.lights) {
    lights.push_back(interpolated(light, frame));
    const Light& now = lights.back();
    if (is_finite(now.position) && is_finite(now.direction) && now.direction != Vec3d{0, 0, 0}) continue;
    return Error{
        ErrorClass::scene, scene.path,
        fmt::format("lights[{}] at frame {}: its position is not finite or its direction zero: put a key between",
                    lights.size() - 1, frame)};
  }
  return lights;
}

std::optional<FrameRange> key_range(const Scene& scene) {
  std::optional<FrameRange> range;
  extend(range, scene.camera.keys);
  for (const Light& light : scene.lights) extend(range, light.keys);
  const auto extend_by = [&](const auto& placement) {
    if (const auto* transform = std::get_if<TransformPlacement>(&placement)) extend(range, transform->keys);
  };
  for (const Character& character : scene.characters) {
    extend_by(character.placement);
    for (const Part& part : character.parts) extend_by(part.placement);
  }
  return range;
}

}  // namespace kd::scene
