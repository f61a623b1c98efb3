// The camera and the lights of a scene file.
#include <fmt/format.h>

#include "scene/motion.h"
#include "scene/scene_reader.h"

namespace kd::scene {

namespace {

LightKind to_kind(scene_fb::LightKind kind) {
  if (kind == scene_fb::LightKind::point) return LightKind::point;
  return kind == scene_fb::LightKind::spot ? LightKind::spot : LightKind::directional;
}

const char* name_of(LightKind kind) {
  if (kind == LightKind::point) return "point";
  return kind == LightKind::spot ? "spot" : "directional";
}

std::string no_field(LightKind kind, const char* field) {
  return fmt::format("a {} light has no '{}': remove it, or change 'kind'", name_of(kind), field);
}

}  // namespace

void Reader::read_camera(const scene_fb::Camera& source) {
  Camera& camera = scene_.camera;
  camera.interpolation = to_interpolation(source.interpolation());
  camera.keys = read_keys<CameraKey>(source.keys(), Place{"camera"},
                                     [](const scene_fb::CameraKey& k, const Place&, CameraKey& key) {
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

Light Reader::read_light(const scene_fb::Light& source, const Place& at) {
  Light light;
  if (!source.kind()) {
    fail(at, "the light lacks 'kind': \"point\", \"directional\" or \"spot\"");
    return light;
  }
  light.kind = to_kind(*source.kind());
  read_light_motion(source, at, light);
  read_light_shape(source, at, light);
  return light;
}

/// What keys may move.
void Reader::read_light_motion(const scene_fb::Light& source, const Place& at, Light& light) {
  const bool has_position = light.kind != LightKind::directional, has_direction = light.kind != LightKind::point;
  const auto check = [&](const scene_fb::Vec3* position, const scene_fb::Vec3* direction, const Place& where) {
    if (position && !has_position) fail(where + ".position", no_field(light.kind, "position"));
    if (direction && !has_direction) fail(where + ".direction", no_field(light.kind, "direction"));
  };
  light.interpolation = to_interpolation(source.interpolation());
  light.keys =
      read_keys<LightKey>(source.keys(), at, [&](const scene_fb::LightKey& k, const Place& at_key, LightKey& key) {
        check(k.position(), k.direction(), at_key);
        if (k.position()) key.position = to_vec3d(*k.position());
        if (k.direction()) key.direction = read_direction(*k.direction(), at_key + ".direction");
        if (k.colour()) key.colour = read_colour(k.colour(), {}, at_key + ".colour");
      });
  check(source.position(), source.direction(), at);
  const auto position = first_of(light.keys, &LightKey::position);
  const auto direction = first_of(light.keys, &LightKey::direction);
  const auto colour = first_of(light.keys, &LightKey::colour);
  const auto need = [&](bool given, const char* name) {
    if (!given) fail(at, fmt::format("a {} light needs a '{}'", name_of(light.kind), name));
  };
  need(!has_position || source.position() || position, "position");
  need(!has_direction || source.direction() || direction, "direction");
  need(source.colour() || colour, "colour");
  light.position = source.position() ? to_vec3d(*source.position()) : position.value_or(light.position);
  light.direction =
      source.direction() ? read_direction(*source.direction(), at + ".direction") : direction.value_or(light.direction);
  light.colour = read_colour(source.colour(), colour.value_or(light.colour), at + ".colour");
}

/// A spot light's cone, and what distance does.
void Reader::read_light_shape(const scene_fb::Light& source, const Place& at, Light& light) {
  const std::optional<double> inner = source.inner_angle(), outer = source.outer_angle(), reach = source.reach();
  if (light.kind == LightKind::spot) {
    if (!inner || !outer) fail(at, "a spot light needs an 'inner_angle' and an 'outer_angle'");
    light.inner_degrees = inner.value_or(0);
    light.outer_degrees = outer.value_or(180);
    if (!(light.outer_degrees > 0 && light.outer_degrees <= 180)) {
      fail(at + ".outer_angle", "'outer_angle' must be more than 0 and at most 180 degrees");
    }
    if (!(light.inner_degrees >= 0 && light.inner_degrees <= light.outer_degrees)) {
      fail(at + ".inner_angle", "'inner_angle' must be from 0 to 'outer_angle'");
    }
  } else {
    if (inner) fail(at + ".inner_angle", no_field(light.kind, "inner_angle"));
    if (outer) fail(at + ".outer_angle", no_field(light.kind, "outer_angle"));
  }
  if (source.falloff() == scene_fb::Falloff::inverse_square) light.falloff = Falloff::inverse_square;
  light.reach = reach.value_or(light.reach);
  if (!(light.reach > 0)) fail(at + ".reach", "'reach' must be more than 0");
  if (light.kind != LightKind::directional) return;
  if (light.falloff != Falloff::none) fail(at + ".falloff", no_field(light.kind, "falloff"));
  if (reach) fail(at + ".reach", no_field(light.kind, "reach"));
}

Vec3d Reader::read_direction(const scene_fb::Vec3& source, const Place& at) {
  const Vec3d direction = normalised(to_vec3d(source));
  if (direction == Vec3d{0, 0, 0}) fail(at, "the light's 'direction' must not be zero");
  return direction;
}

}  // namespace kd::scene
