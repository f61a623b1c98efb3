// A scene: what a scene file says, as plain structs. Scene space, right-handed, in double; colours scene-linear; angles
// in degrees. `parse_scene` keeps the ranges named here; who fills a Scene by hand keeps them too.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/frame.h"
#include "core/material.h"
#include "core/vec.h"

namespace kd::scene {

constexpr uint32_t kMaxFilmSide = 65536;         // pixels
constexpr uint64_t kMaxFilmPixels = 1ull << 28;  // width x height
constexpr int kMaxNesting = 16;                  // characters within one another, the outermost included
constexpr uint32_t kMaxInstances = 1u << 26;     // of all shown characters together

/// In pixels, each from 1 to kMaxFilmSide, their product at most kMaxFilmPixels.
struct FilmSize {
  uint32_t width = 512;
  uint32_t height = 512;
};

/// How a field goes from key to key: straight, or by a curve whose velocity has no jumps.
enum class Interpolation : uint8_t { linear, smooth };

constexpr double kMaxKeyFrame = 1e9;  // and -1e9 the least

/// Keys say what some of a thing's fields are at a frame; frames increase strictly. A field goes through the keys that
/// give it, and is held before the first and after the last of them. What no key gives stays as it is.
struct CameraKey {
  double frame = 0;
  std::optional<Vec3d> position;
  std::optional<Vec3d> target;
  std::optional<Vec3d> up;
  std::optional<double> vertical_fov_degrees;
};

/// Looks from `position` to `target`, which differ; `up` is not parallel to that way, and need not be perpendicular.
struct Camera {
  Vec3d position{0, 0, 0};
  Vec3d target{0, 0, -1};
  Vec3d up{0, 1, 0};
  double vertical_fov_degrees = 45;  // over the film's height, between 0 and 180
  std::vector<CameraKey> keys = {};
  Interpolation interpolation = Interpolation::linear;
};

enum class LightKind : uint8_t { point, directional, spot };

/// What the distance d does to a light: nothing, as in the paper, or colour / d^2.
enum class Falloff : uint8_t { none, inverse_square };

struct LightKey {
  double frame = 0;
  std::optional<Vec3d> position;
  std::optional<Vec3d> direction;
  std::optional<Vec3f> colour;
};

inline bool is_black(Vec3f colour) { return colour.x == 0 && colour.y == 0 && colour.z == 0; }

struct Light {
  LightKind kind = LightKind::point;
  Vec3d position{0, 0, 0};    // scene space; of a point or spot light
  Vec3d direction{0, -1, 0};  // the way the light travels, length 1; of a directional or spot light
  Vec3f colour{1, 1, 1};      // >= 0
  // Of a spot light: s^2 (3 - 2s) of its light arrives at an angle a from its direction, s = saturate((cos a - cos
  // outer) / (cos inner - cos outer)); all or nothing if the two are the same. 0 <= inner <= outer <= 180, 0 < outer.
  double inner_degrees = 0;
  double outer_degrees = 45;
  // Of a point or spot light. A reach, > 0, is a window: saturate(1 - (d / reach)^4)^2 of the light arrives, nothing
  // from there on (Karis, "Real shading in Unreal Engine 4", 2013).
  Falloff falloff = Falloff::none;
  double reach = std::numeric_limits<double>::infinity();
  std::vector<LightKey> keys = {};
  Interpolation interpolation = Interpolation::linear;
};

struct SceneObject {
  std::string name;  // no two the same
  std::string file;  // a .nkd; a path that can be opened from the working directory
};

/// The object's unit cube fills the box.
struct BoxPlacement {
  Frame box;
};

struct Rotation {
  Vec3d axis{0, 0, 1};  // not zero, of any length
  double degrees = 0;   // counterclockwise
};

struct TransformKey {
  double frame = 0;
  std::optional<Vec3d> translate;
  std::optional<Rotation> rotate;
  std::optional<Vec3d> scale;
};

/// Applied to the object's model space: scaled first, then rotated counterclockwise about the axis, then moved.
struct TransformPlacement {
  Vec3d translate{0, 0, 0};
  Vec3d rotate_axis{0, 0, 1};  // not zero, of any length
  double rotate_degrees = 0;
  Vec3d scale{1, 1, 1};  // no component is zero; a negative one mirrors
  std::vector<TransformKey> keys = {};
  Interpolation interpolation = Interpolation::linear;
};

/// The object's model space to scene space, by any invertible affine map.
struct FramePlacement {
  Frame frame;
};

using Placement = std::variant<BoxPlacement, TransformPlacement, FramePlacement>;
/// The same without a box: a character has no unit cube.
using CharacterPlacement = std::variant<TransformPlacement, FramePlacement>;

/// Which sides of surfaces the camera sees; the front is where a triangle's corners are wound counterclockwise.
enum class Sides : uint8_t { both, front };

struct Part {
  std::string name;     // may be empty
  uint32_t object = 0;  // index into Scene::objects; not read if the part places a character
  Placement placement = TransformPlacement{};
  std::optional<Material> material;   // instead of those of everything below it: a part further out wins
  int line = 0;                       // in the scene file, from 1, for errors that only its object's box can show
  std::optional<uint32_t> character;  // index into Scene::characters: the part places it, and no object
  std::optional<Sides> sides;         // of everything below it: a part further out wins; both where none says
};

/// Characters may place one another, but none itself, not even through others, and at most kMaxNesting deep.
struct Character {
  std::string name;  // may be empty
  std::vector<Part> parts;
  CharacterPlacement placement = TransformPlacement{};  // of its parts' space in the space around it
  bool shown = true;                                    // else it is seen only where parts place it
  int line = 0;                                         // as a part's
};

struct Scene {
  std::string path;  // of the scene file, for errors
  FilmSize film;
  Camera camera;
  Vec3f background{0, 0, 0};  // >= 0, as all colours; what a ray that meets nothing returns
  Vec3f ambient{0, 0, 0};
  std::vector<Light> lights;
  std::vector<SceneObject> objects;  // those that the scene file lists, then those of the library that parts place
  std::string library;               // a folder; empty: none
  std::vector<Character> characters;
};

/// Where a library has the object of this name.
inline std::string library_file(const std::string& library, const std::string& name) {
  return library + "/" + name + ".nkd";
}

}  // namespace kd::scene
