// Keys: what is read, how fields go from key to key, and what keys cannot be.
#include "scene/motion.h"

#include <cmath>
#include <numbers>
#include <string>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "scene/instances.h"
#include "scene/parse_scene.h"
#include "scene/placement.h"

using namespace kd;
using namespace kd::scene;

namespace {

constexpr double kRadians = std::numbers::pi / 180;

TransformPlacement with_keys(std::vector<TransformKey> keys, Interpolation interpolation) {
  TransformPlacement t;
  t.keys = std::move(keys);
  t.interpolation = interpolation;
  return t;
}

TransformPlacement moves(const std::vector<std::pair<double, Vec3d>>& keys, Interpolation interpolation) {
  std::vector<TransformKey> out;
  for (const auto& [frame, p] : keys) out.push_back({frame, p, {}, {}});
  return with_keys(std::move(out), interpolation);
}

TransformPlacement turns(const std::vector<std::pair<double, Rotation>>& keys, Interpolation interpolation) {
  std::vector<TransformKey> out;
  for (const auto& [frame, r] : keys) out.push_back({frame, {}, r, {}});
  return with_keys(std::move(out), interpolation);
}

Vec3d position(const TransformPlacement& t, double frame) { return interpolated(t, frame).translate; }

Frame turn(const TransformPlacement& t, double frame) { return placement_frame(Placement{t}, frame); }

/// The angle between two rotations, in degrees.
double angle_between(const Frame& a, const Frame& b) {
  const double trace = dot(a.x_axis, b.x_axis) + dot(a.y_axis, b.y_axis) + dot(a.z_axis, b.z_axis);
  const Vec3d sines = cross(a.x_axis, b.x_axis) + cross(a.y_axis, b.y_axis) + cross(a.z_axis, b.z_axis);
  return std::atan2(length(sines) / 2, (trace - 1) / 2) / kRadians;
}

/// The way a rotation goes from one frame to another, in degrees.
double path_length(const TransformPlacement& t, double from, double to) {
  double sum = 0;
  constexpr int kSteps = 1000;
  for (int i = 0; i < kSteps; ++i) {
    sum += angle_between(turn(t, from + (to - from) * i / kSteps), turn(t, from + (to - from) * (i + 1) / kSteps));
  }
  return sum;
}

Scene parsed(const std::string& camera, const std::string& light, const std::string& part) {
  const std::string text =
      fmt::format(R"({{"camera": {{{}}}, "lights": [{{{}}}], "objects": [{{"name": "a", "file": "a.nkd"}}],
"characters": [{{"parts": [{{"object": "a"{}}}]}}]}})",
                  camera, light, part);
  const auto scene = parse_scene(text, "s");
  REQUIRE_MESSAGE(scene, (scene ? "" : scene.error().line()));
  return *scene;
}

const std::string kCamera = R"("position": [0, 0, 5], "target": [0, 0, 0])";
const std::string kLight = R"("kind": "point", "position": [0, 0, 5], "colour": [1, 1, 1])";

}  // namespace

TEST_CASE("motion: linear goes straight, and is held outside") {
  const auto t = moves({{10, {1, 0, 0}}, {20, {3, 4, 0}}, {60, {3, 0, 8}}}, Interpolation::linear);
  CHECK(position(t, -1e300) == Vec3d{1, 0, 0});
  CHECK(position(t, 10) == Vec3d{1, 0, 0});
  CHECK(position(t, 15) == Vec3d{2, 2, 0});
  CHECK(position(t, 20) == Vec3d{3, 4, 0});
  CHECK(position(t, 30) == Vec3d{3, 3, 2});
  CHECK(position(t, 60) == Vec3d{3, 0, 8});
  CHECK(position(t, 1e300) == Vec3d{3, 0, 8});
  CHECK(interpolated(t, 15).keys.empty());
}

TEST_CASE(
    "motion: smooth has one velocity at each key whatever the frames between, none at the ends, and keeps a line") {
  const auto t = moves({{0, {0, 5, 0}}, {10, {1, 5, 7}}, {12, {4, 5, 2}}, {50, {5, 5, 0}}, {51, {0, 5, 9}}},
                       Interpolation::smooth);
  const double h = 1e-6;
  for (const double key : {0.0, 10.0, 12.0, 50.0, 51.0}) {
    CAPTURE(key);
    const Vec3d before = (position(t, key) - position(t, key - h)) * (1 / h);
    const Vec3d after = (position(t, key + h) - position(t, key)) * (1 / h);
    CHECK(length(after - before) < 1e-4);
    if (key == 0 || key == 51) CHECK(length(after) < 1e-4);
    if (key == 10) CHECK(length(after - Vec3d{4, 0, 2} * (1 / 12.0)) < 1e-4);  // of the neighbours
  }
  CHECK(position(t, 12) == Vec3d{4, 5, 2});
  for (double f = 0; f < 51; f += 0.37) CHECK(position(t, f).y == 5);

  const auto line = moves({{0, {0, 0, 0}}, {1, {1, 0, 0}}, {4, {4, 0, 0}}, {5, {5, 0, 0}}}, Interpolation::smooth);
  for (double f = 1; f <= 4; f += 0.1) CHECK(position(line, f).x == doctest::Approx(f).epsilon(1e-14));
}

TEST_CASE("motion: each field goes through the keys that give it") {
  const auto t = with_keys({{0, Vec3d{0, 0, 0}, {}, {}}, {5, {}, {}, Vec3d{2, 2, 2}}, {10, Vec3d{10, 0, 0}, {}, {}}},
                           Interpolation::linear);
  CHECK(interpolated(t, 5).translate == Vec3d{5, 0, 0});
  CHECK(interpolated(t, 0).scale == Vec3d{2, 2, 2});
  CHECK(interpolated(t, 9).scale == Vec3d{2, 2, 2});
  CHECK(interpolated(t, 9).rotate_degrees == 0);
}

TEST_CASE("motion: about one axis, the degrees are what the keys say") {
  const Vec3d y{0, 2, 0};
  const auto full = turns({{1, {y, 0}}, {5, {y, 360}}}, Interpolation::linear);
  CHECK(interpolated(full, 2).rotate_degrees == 90);
  CHECK(turn(full, 2).x_axis == Vec3d{0, 0, -1});
  CHECK(interpolated(full, 3).rotate_degrees == 180);
  const auto opposite = turns({{0, {y, -90}}, {1, {-y, -270}}}, Interpolation::linear);
  CHECK(angle_between(turn(opposite, 0.5), turn(turns({{0, {y, 90}}}, Interpolation::linear), 0)) < 1e-9);
  CHECK(path_length(opposite, 0, 1) == doctest::Approx(360));
  const auto any = turns({{0, {{1, 0, 0}, 0}}, {1, {y, 720}}}, Interpolation::smooth);
  CHECK(path_length(any, 0, 1) == doctest::Approx(720));
  const auto thirds = turns({{0, {y, 0}}, {10, {y, 120}}, {20, {y, 240}}, {30, {y, 360}}}, Interpolation::smooth);
  CHECK(interpolated(thirds, 15).rotate_degrees == doctest::Approx(180).epsilon(1e-14));
  CHECK(path_length(thirds, 0, 30) == doctest::Approx(360));
}

TEST_CASE("motion: between different axes, the short way at one speed") {
  const Rotation a{{1, 0, 0}, 90}, b{{0, 1, 0}, 90};
  const auto t = turns({{0, a}, {4, b}}, Interpolation::linear);
  CHECK(angle_between(turn(t, 0), turn(t, 4)) == doctest::Approx(120));
  for (const double f : {1.0, 2.0, 3.0}) CHECK(angle_between(turn(t, 0), turn(t, f)) == doctest::Approx(30 * f));
  // 350 degrees about another axis are 10 the other way.
  const auto near = turns({{0, {{1, 0, 0}, 10}}, {1, {{1, 0.1, 0}, 350}}}, Interpolation::linear);
  CHECK(path_length(near, 0, 1) < 21);
}

TEST_CASE("motion: smooth rotations meet their keys with one angular velocity, at rest at the ends") {
  const auto t = turns({{0, {{1, 0, 0}, 30}}, {3, {{0, 1, 0}, 80}}, {10, {{0, 1, 0}, 500}}, {12, {{1, 1, 1}, 100}}},
                       Interpolation::smooth);
  const double h = 1e-5;
  const auto velocity = [&](double from, double to) {
    const Frame a = turn(t, from), b = turn(t, to);
    return (cross(a.x_axis, b.x_axis) + cross(a.y_axis, b.y_axis) + cross(a.z_axis, b.z_axis)) *
           (1 / (2 * (to - from)));
  };
  for (const TransformKey& key : t.keys) {
    CAPTURE(key.frame);
    const auto alone = turns({{0, *key.rotate}}, Interpolation::linear);
    CHECK(angle_between(turn(t, key.frame), turn(alone, 0)) < 1e-9);
    CHECK(angle_between(turn(t, key.frame - 1e-9), turn(alone, 0)) < 1e-5);
    const Vec3d before = velocity(key.frame - h, key.frame), after = velocity(key.frame, key.frame + h);
    CHECK(length(after - before) < 1e-3);
    if (key.frame == 0 || key.frame == 12) CHECK(length(after) + length(before) < 1e-3);
  }
  CHECK(path_length(t, 3, 10) > 400);  // the turn and more of the second segment is not lost
  CHECK(path_length(t, 3, 10) < 520);
}

TEST_CASE("motion: a camera and lights with keys") {
  const Scene s = parsed(
      R"("target": [0, 0, 0], "keys": [{"frame": 1, "position": [0, 0, 4]}, {"frame": 3, "position": [4, 0, 0], "vertical_fov": 30}])",
      R"("kind": "directional", "keys": [{"frame": 0, "direction": [0, 0, -2], "colour": [0, 4, 0]}, {"frame": 10, "direction": [0, 3, 0]},
         {"frame": 20, "colour": [2, 0, 0]}])",
      "");
  CHECK(s.camera.position == Vec3d{0, 0, 4});
  const auto camera = camera_at(s, 2);
  REQUIRE(camera);
  CHECK(camera->position == Vec3d{2, 0, 2});
  CHECK(camera->vertical_fov_degrees == 30);
  CHECK(camera->keys.empty());
  const auto lights = lights_at(s, 5);
  REQUIRE(lights);
  CHECK(length(lights->at(0).direction - Vec3d{0, std::sqrt(0.5), -std::sqrt(0.5)}) < 1e-15);
  CHECK(lights->at(0).colour == Vec3f{0.5f, 3, 0});
  const auto range = key_range(s);
  REQUIRE(range);
  CHECK(range->first == 0);
  CHECK(range->last == 20);
  CHECK_FALSE(key_range(parsed(kCamera, kLight, "")));
}

TEST_CASE("motion: colours that overshoot are cut off; a camera that comes to look nowhere is an error") {
  const Scene s = parsed(
      R"("position": [0, 0, 5], "keys": [{"frame": 0, "target": [0, 0, 6]}, {"frame": 2, "target": [0, 0, 4]}])",
      R"("kind": "directional", "interpolation": "smooth", "keys": [{"frame": 0, "direction": [0, 0, 1], "colour": [9, 0, 0]},
         {"frame": 1, "colour": [0, 0, 0]}, {"frame": 2, "colour": [0, 9, 0]}, {"frame": 3, "direction": [0, 0, -1]}])",
      "");
  for (double f = 0; f < 3; f += 0.1) {
    const auto lights = lights_at(s, f);
    REQUIRE(lights);
    CHECK((lights->at(0).colour.x >= 0 && lights->at(0).colour.y >= 0));
  }
  REQUIRE_FALSE(lights_at(s, 1.5));
  CHECK(lights_at(s, 1.5).error().line().starts_with("s: lights[0] at frame 1.5: "));
  CHECK(camera_at(s, 0.5));
  REQUIRE_FALSE(camera_at(s, 1));
  CHECK(camera_at(s, 1).error().line() == "s: at frame 1: the camera's target is its position: move one of them");
}

TEST_CASE("motion: instances at a frame") {
  const Scene s = parsed(
      kCamera, kLight,
      R"(, "scale": [2, 2, 2], "keys": [{"frame": 1, "translate": [0, 0, 0]}, {"frame": 5, "translate": [8, 0, 0]},
                         {"frame": 6, "scale": [1, 1, 1]}, {"frame": 8, "scale": [-1, 1, 1]}])");
  const std::vector<Lattice> cube{Lattice{{0, 0, 0}, {1, 1, 1}, 4}};
  const auto at = [&](double frame) { return place_instances(s, cube, frame)->at(0).lattice_to_scene; };
  CHECK(at(3).point == Vec3d{4, 0, 0});
  CHECK(at(3).x_axis == Vec3d{1 / 15.0, 0, 0});
  CHECK(at(100).x_axis == Vec3d{-1 / 15.0, 0, 0});
  const auto flat = place_instances(s, cube, 7);
  REQUIRE_FALSE(flat);
  CHECK(flat.error().line().starts_with("s:2: a part of 'a': the placement is singular"));
}

TEST_CASE("motion: what keys cannot be") {
  const auto error_of = [](const std::string& camera, const std::string& light, const std::string& part) {
    const std::string text = fmt::format(
        "{{\"camera\": {{{}}},\n\"lights\": [{{{}}}], \"objects\": [{{\"name\": \"a\", \"file\": "
        "\"a.nkd\"}}],\n\"characters\": [{{\"parts\": [{{\"object\": \"a\"{}}}]}}]}}",
        camera, light, part);
    const auto scene = parse_scene(text, "s");
    REQUIRE(!scene);
    return scene.error().line();
  };
  const auto part_error = [&](const std::string& part) { return error_of(kCamera, kLight, ", " + part); };
  CHECK(part_error(R"("keys": [{}])") == "s:3:52: the key lacks 'frame'");
  CHECK(part_error(R"("keys": [{"frame": 2}, {"frame": 2}])") ==
        "s:3:76: the frames of keys must increase, and 2 does not follow 2");
  CHECK(part_error(R"("keys": [{"frame": 1e10}])") == "s:3:62: 'frame' must be from -1e9 to 1e9");
  CHECK(part_error(R"("keys": [{"frame": 1, "scale": [1, 0, 1]}])").ends_with("no component of 'scale' may be zero"));
  CHECK(part_error(R"("keys": [{"frame": 1, "rotate": {"axis": [0, 0, 0], "degrees": 1}}])")
            .ends_with("must not be zero"));
  CHECK(
      part_error(R"("keys": [{"frame": 1, "rotate": {"axis": [0, 0, 1]}}])").ends_with("the rotation lacks 'degrees'"));
  CHECK(part_error(R"("keys": [{"frame": 1, "position": [0, 0, 1]}])").find("unknown field 'position'") !=
        std::string::npos);
  CHECK(part_error(R"("interpolation": "cubic")").ends_with("must be \"linear\" or \"smooth\", not \"cubic\""));
  const std::string axes = R"({"point": [0, 0, 0], "x_axis": [1, 0, 0], "y_axis": [0, 1, 0], "z_axis": [0, 0, 1]})";
  CHECK(part_error("\"keys\": [{\"frame\": 1}], \"frame\": " + axes)
            .ends_with("'keys' does not go with 'frame': keep one of them"));
  CHECK(part_error("\"keys\": [{\"frame\": 1}], \"box\": " + axes)
            .ends_with("'keys' does not go with 'box': keep one of them"));
  CHECK(error_of(kCamera + R"(, "keys": [{"frame": 1, "vertical_fov": 180}])", kLight, "") ==
        "s:1:95: the camera's 'vertical_fov' must be more than 0 and less than 180 degrees (frame 1)");
  CHECK(error_of(R"("position": [0, 0, 0], "keys": [{"frame": 1, "up": [0, 1, 0]}])", kLight, "") ==
        "s:1:12: 'camera' lacks 'target'");
  CHECK(error_of(kCamera + R"(, "keys": [{"frame": 3, "target": [0, 0, 5]}])", kLight, "")
            .starts_with("s:1:89: the camera's target is its position"));
  CHECK(error_of(kCamera, kLight + R"(, "keys": [{"frame": 1, "direction": [0, 0, 1]}])", "")
            .find("a point light has no 'direction'") != std::string::npos);
  CHECK(error_of(kCamera, kLight + R"(, "keys": [{"frame": 1, "colour": [0, 0, -1]}])", "")
            .find("components of a colour") != std::string::npos);
  CHECK(error_of(kCamera, R"("kind": "point", "position": [0, 0, 1])", "") == "s:2:12: a point light needs a 'colour'");
}
