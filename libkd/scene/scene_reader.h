// From the parsed tables to a Scene: what the schema cannot say is checked here. Internal to this room.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include "scene/json_locate.h"
#include "scene/scene.h"
#include "scene_generated.h"
#include "sys/result.h"

namespace kd::scene {

/// The schema that a scene file is of.
const reflection::Schema& scene_schema();

/// "path:line:column".
std::string place_in_file(const std::string& path, Position at);

/// Lines of the tables, each kind in the order of the text.
struct TableLines {
  std::vector<int> characters;
  std::vector<int> parts;
};

/// Whether a colour's component or an exponent is in range.
bool fits_float(double v);

inline Vec3d to_vec3d(const scene_fb::Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// Where in the JSON a value stands: a step from the value around it, which it refers to. Written out only for errors,
/// because a scene may have a million values.
struct Place {
  static constexpr size_t kNoIndex = ~size_t{0};

  std::string_view name;  // ".parts", or without a dot at the root
  const Place* outer = nullptr;
  size_t index = kNoIndex;

  /// "parts[2]".
  std::string last() const;
  /// "characters[0].parts[2]".
  std::string text() const;
};

inline Place operator+(const Place& outer, std::string_view name) { return {name, &outer}; }

/// Turns the parsed tables into a Scene and checks what the schema cannot say. A failed check records an error, the
/// first one only, and reading goes on with whatever is there; `read` then returns the error.
class Reader {
 public:
  Reader(std::string_view json, const std::string& path, const TableLines& lines);

  Result<Scene> read(const scene_fb::Scene& source);

 private:
  void read_film(const scene_fb::Film& source);
  void read_camera(const scene_fb::Camera& source);
  void check_camera();
  Light read_light(const scene_fb::Light& source, const Place& at);
  void read_light_motion(const scene_fb::Light& source, const Place& at, Light& light);
  void read_light_shape(const scene_fb::Light& source, const Place& at, Light& light);
  Vec3d read_direction(const scene_fb::Vec3& source, const Place& at);
  /// `read_fields(source key, path, key)` reads what is not the frame.
  template <class Key, class Sources, class ReadFields>
  std::vector<Key> read_keys(const Sources* sources, const Place& at, const ReadFields& read_fields);
  double read_frame(std::optional<double> source, std::optional<double> before, const Place& at);
  SceneObject read_object(const scene_fb::Object& source, const Place& at);
  void name_characters(const scene_fb::Scene& source);
  Character read_character(const scene_fb::Character& source, const Place& at);
  Part read_part(const scene_fb::Part& source, const Place& at);
  void read_placed(const scene_fb::Part& source, const Place& at, Part& part);
  template <class Source>
  TransformPlacement read_transform(const Source& source, const Place& at);
  template <class Source>
  CharacterPlacement read_placement(const Source& source, const Place& at);
  template <class Source>
  void exclude_transform(const Source& source, const char* given, const Place& at);
  Rotation read_rotation(const scene_fb::Rotation& source, const Place& at);
  Vec3d read_scale(const scene_fb::Vec3& source, const Place& at);
  void check_nesting();
  Material read_material(const scene_fb::Material& source, const Place& at);
  /// `name`: of a file, as the scene has it.
  std::string from_folder(const std::string& name) const { return name.starts_with('/') ? name : folder_ + name; }
  void read_objects(const scene_fb::Scene& source);
  uint32_t find_object(const flatbuffers::String& name, const Place& at);
  uint32_t find_character(const flatbuffers::String& name, const Place& at);

  std::string read_text(const flatbuffers::String* source, const Place& at);
  std::string read_name(const flatbuffers::String& source, const Place& at);
  Vec3f read_colour(const scene_fb::Vec3* source, Vec3f otherwise, const Place& at);

  /// `present`: a field of the table `at` that does not go with its field `given`, if not null.
  void exclude(const void* present, const char* name, const char* given, const Place& at);
  void fail(const Place& at, std::string what) {
    if (!error_) fail(at.text(), std::move(what));
  }
  /// `at`: the faulty value's path in the JSON, such as "characters[0].parts[2].scale".
  void fail(const std::string& at, std::string what) {
    if (!error_)
      error_ = Error{ErrorClass::scene, place_in_file(path_, locate(json_, scene_schema(), at)), std::move(what)};
  }

  std::string_view json_;
  const std::string& path_;
  const TableLines& lines_;
  const std::string folder_;  // of the scene file, with a slash behind it; empty: the working directory
  size_t parts_read_ = 0;
  Scene scene_;
  std::unordered_map<std::string, uint32_t> object_index_;
  std::unordered_map<std::string, uint32_t> character_index_;  // kAmbiguous: of several
  std::optional<Error> error_;
};

template <class Key, class Sources, class ReadFields>
std::vector<Key> Reader::read_keys(const Sources* sources, const Place& at, const ReadFields& read_fields) {
  std::vector<Key> keys;
  if (!sources) return keys;
  for (const auto* source : *sources) {
    const Place at_key{".keys", &at, keys.size()};
    Key key;
    key.frame = read_frame(source->frame(), keys.empty() ? std::nullopt : std::optional(keys.back().frame), at_key);
    read_fields(*source, at_key, key);
    keys.push_back(key);
  }
  return keys;
}

/// The first value that keys give a field, for a thing that is not told what it is without them.
template <class Key, class T>
std::optional<T> first_of(const std::vector<Key>& keys, std::optional<T> Key::*field) {
  for (const Key& key : keys) {
    if (key.*field) return key.*field;
  }
  return std::nullopt;
}

inline Interpolation to_interpolation(scene_fb::Interpolation source) {
  return source == scene_fb::Interpolation::smooth ? Interpolation::smooth : Interpolation::linear;
}

}  // namespace kd::scene
