// The camera and the lights of a scene file.
#include <fmt/format.h>

#include "scene/scene_reader.h"

namespace kd::scene {

namespace {

/// Below this sine of the angle between them, `up` counts as parallel to the view direction.
constexpr double kParallelSine = 1e-6;

}  // namespace

void Reader::read_camera(const scene_fb::Camera& source) {
  Camera& camera = scene_.camera;
  camera.position = to_vec3d(*source.position());
  camera.target = to_vec3d(*source.target());
  if (source.up()) camera.up = to_vec3d(*source.up());
  camera.vertical_fov_degrees = source.vertical_fov();

  const Vec3d view = camera.target - camera.position;
  if (view == Vec3d{0, 0, 0}) fail("camera.target", "the camera's target is its position: move one of them");
  if (!is_finite(view)) fail("camera.target", "the camera's target is too far from its position");
  if (!(length(cross(normalised(camera.up), normalised(view))) > kParallelSine)) {
    fail("camera.up", "the camera's 'up' is zero or parallel to the way it looks: choose another direction");
  }
  if (!(camera.vertical_fov_degrees > 0 && camera.vertical_fov_degrees < 180)) {
    fail("camera.vertical_fov", "the camera's 'vertical_fov' must be more than 0 and less than 180 degrees");
  }
}

Light Reader::read_light(const scene_fb::Light& source, const std::string& at) {
  Light light;
  light.colour = read_colour(source.colour(), light.colour, at + ".colour");
  if (!source.kind()) {
    fail(at, "the light lacks 'kind': \"point\" or \"directional\"");
    return light;
  }
  if (*source.kind() == scene_fb::LightKind::point) {
    light.kind = LightKind::point;
    if (source.direction()) fail(at + ".direction", "a point light has no 'direction': remove it, or change 'kind'");
    if (!source.position()) fail(at, "a point light needs a 'position'");
    if (source.position()) light.position = to_vec3d(*source.position());
  } else {
    light.kind = LightKind::directional;
    if (source.position()) fail(at + ".position", "a directional light has no 'position': remove it, or change 'kind'");
    if (!source.direction()) fail(at, "a directional light needs a 'direction'");
    if (source.direction()) light.direction = normalised(to_vec3d(*source.direction()));
    if (light.direction == Vec3d{0, 0, 0}) fail(at + ".direction", "the light's 'direction' must not be zero");
  }
  return light;
}

}  // namespace kd::scene
