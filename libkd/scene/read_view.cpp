// The camera and the lights of a scene file.
#include <fmt/format.h>

#include "scene/motion.h"
#include "scene/scene_reader.h"

namespace kd::scene {

void Reader::read_camera(const scene_fb::Camera& source) {
  Camera& camera = scene_.camera;
  camera.interpolation = to_interpolation(source.interpolation());
  camera.keys = read_keys<CameraKey>(source.keys(), "camera",
                                     [](const scene_fb::CameraKey& k, const std::string&, CameraKey& key) {
                                       if (k.position()) key.position = to_vec3d(*k.position());
                                       if (k.target()) key.target = to_vec3d(*k.target());
                                       if (k.up()) key.up = to_vec3d(*k.up());
                                       key.vertical_fov_degrees = k.vertical_fov();
                                     });
  const auto needed = [&](const scene_fb::Vec3* given, std::optional<Vec3d> of_keys, const char* name) {
    if (!given && !of_keys) fail("camera", fmt::format("'camera' lacks '{}'", name));
    return given ? to_vec3d(*given) : of_keys.value_or(Vec3d{});
  };
  camera.position = needed(source.position(), first_of(camera.keys, &CameraKey::position), "position");
  camera.target = needed(source.target(), first_of(camera.keys, &CameraKey::target), "target");
  if (source.up()) camera.up = to_vec3d(*source.up());
  camera.vertical_fov_degrees = source.vertical_fov();
  check_camera();
}

/// As it is, or if it has keys, at each of them.
void Reader::check_camera() {
  if (scene_.camera.keys.empty()) {
    if (const auto fault = find_fault(scene_.camera)) fail(fmt::format("camera.{}", fault->field), fault->what);
  }
  for (size_t i = 0; i < scene_.camera.keys.size(); ++i) {
    const double frame = scene_.camera.keys[i].frame;
    const auto fault = find_fault(interpolated(scene_.camera, frame));
    if (fault)
      fail(fmt::format("camera.keys[{}].{}", i, fault->field), fmt::format("{} (frame {})", fault->what, frame));
  }
}

Light Reader::read_light(const scene_fb::Light& source, const std::string& at) {
  Light light;
  if (!source.kind()) {
    fail(at, "the light lacks 'kind': \"point\" or \"directional\"");
    return light;
  }
  const bool is_point = *source.kind() == scene_fb::LightKind::point;
  light.kind = is_point ? LightKind::point : LightKind::directional;
  const char* kind = is_point ? "point" : "directional";
  const auto check_kind = [&](const scene_fb::Vec3* position, const scene_fb::Vec3* direction,
                              const std::string& where) {
    const char* other = is_point ? "direction" : "position";
    if (!(is_point ? direction : position)) return;
    fail(fmt::format("{}.{}", where, other),
         fmt::format("a {} light has no '{}': remove it, or change 'kind'", kind, other));
  };
  light.interpolation = to_interpolation(source.interpolation());
  light.keys = read_keys<LightKey>(source.keys(), at,
                                   [&](const scene_fb::LightKey& k, const std::string& at_key, LightKey& key) {
                                     check_kind(k.position(), k.direction(), at_key);
                                     if (k.position()) key.position = to_vec3d(*k.position());
                                     if (k.direction())
                                       key.direction = read_direction(*k.direction(), at_key + ".direction");
                                     if (k.colour()) key.colour = read_colour(k.colour(), {}, at_key + ".colour");
                                   });
  check_kind(source.position(), source.direction(), at);
  const auto needed = [&](bool is_given, const char* name) {
    if (!is_given) fail(at, fmt::format("a {} light needs a '{}'", kind, name));
  };
  const auto position = first_of(light.keys, &LightKey::position),
             direction = first_of(light.keys, &LightKey::direction);
  const auto colour = first_of(light.keys, &LightKey::colour);
  if (is_point) needed(source.position() || position, "position");
  if (!is_point) needed(source.direction() || direction, "direction");
  needed(source.colour() || colour, "colour");
  light.position = source.position() ? to_vec3d(*source.position()) : position.value_or(light.position);
  light.direction =
      source.direction() ? read_direction(*source.direction(), at + ".direction") : direction.value_or(light.direction);
  light.colour = read_colour(source.colour(), colour.value_or(light.colour), at + ".colour");
  return light;
}

Vec3d Reader::read_direction(const scene_fb::Vec3& source, const std::string& at) {
  const Vec3d direction = normalised(to_vec3d(source));
  if (direction == Vec3d{0, 0, 0}) fail(at, "the light's 'direction' must not be zero");
  return direction;
}

}  // namespace kd::scene
