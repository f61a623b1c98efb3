#include "scene/write_scene.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <limits>
#include <optional>
#include <string_view>
#include <system_error>
#include <unordered_set>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "sys/atomic_file.h"
#include "sys/hash.h"
#include "sys/mapped_file.h"

namespace kd::scene {

namespace {

namespace fs = std::filesystem;

/// How a file begins that has `rest` behind this.
std::string head_of(std::string_view rest) {
  return fmt::format("{{\n  \"generator\": \"kdtrace, XXH3 {}\",\n", hash_text(hash_bytes(rest.data(), rest.size())));
}

/// Bytes of the UTF-8 character that `text` begins with; 0 if it begins with none. No surrogates, no overlong forms.
size_t character_length(std::string_view text) {
  const auto byte = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const auto goes_on = [&](size_t i) { return (byte(i) & 0xc0) == 0x80; };
  const unsigned a = byte(0), b = byte(1);
  if (a < 0x80) return 1;
  if (a >= 0xc2 && a <= 0xdf && goes_on(1)) return 2;
  if (a >= 0xe0 && a <= 0xef && goes_on(1) && goes_on(2)) {
    return (a == 0xe0 && b < 0xa0) || (a == 0xed && b >= 0xa0) ? 0 : 3;
  }
  if (a >= 0xf0 && a <= 0xf4 && goes_on(1) && goes_on(2) && goes_on(3)) {
    return (a == 0xf0 && b < 0x90) || (a == 0xf4 && b >= 0x90) ? 0 : 4;
  }
  return 0;
}

/// `text` with everything that no name in a scene may hold replaced.
std::string clean_text(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const size_t length = character_length(text);
    const bool is_control = static_cast<unsigned char>(text[0]) < ' ' || text[0] == 0x7f;
    out += length == 0 || is_control ? "\xEF\xBF\xBD" : text.substr(0, length);
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return out;
}

std::string json_string(std::string_view clean) {
  std::string out = "\"";
  for (const char c : clean) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

/// `name` clean and not empty, numbered from `number` on until it is none of those taken, which it then is.
std::string free_name(const std::string& name, const char* otherwise, size_t number,
                      std::unordered_set<std::string>& taken) {
  const std::string clean = clean_text(name.empty() ? otherwise : name);
  std::string out = clean;
  for (size_t i = number; !taken.insert(out).second; ++i) out = fmt::format("{} {}", clean, i);
  return out;
}

/// Names as they are written: clean, not empty, no two the same.
std::vector<std::string> object_names(const Scene& scene) {
  std::unordered_set<std::string> taken;
  std::vector<std::string> names;
  for (const SceneObject& object : scene.objects) {
    names.push_back(free_name(object.name, "object", names.size() + 1, taken));
  }
  return names;
}

/// The same, but a character that no part places may have any name, or none.
std::vector<std::string> character_names(const Scene& scene) {
  std::vector<bool> placed(scene.characters.size(), false);
  for (const Character& character : scene.characters) {
    for (const Part& part : character.parts) {
      if (part.character) placed[*part.character] = true;
    }
  }
  std::unordered_set<std::string> taken;
  std::vector<std::string> names;
  for (const Character& character : scene.characters) names.push_back(clean_text(character.name));
  for (size_t i = 0; i < names.size(); ++i) {
    if (!placed[i]) taken.insert(names[i]);
  }
  for (size_t i = 0; i < names.size(); ++i) {
    if (placed[i]) names[i] = free_name(names[i], "character", i + 1, taken);
  }
  return names;
}

/// The folder of `path` without links, where that can be found out: `..` leads elsewhere behind one.
fs::path folder_of(const fs::path& path) {
  std::error_code fault;
  const fs::path folder = fs::absolute(path, fault).parent_path();
  const fs::path resolved = fs::weakly_canonical(folder, fault);
  return fault ? folder.lexically_normal() : resolved;
}

/// `file`, as it can be opened from the working directory, relative to the folder of `scene_path`. It may be a link.
fs::path relative_file(const std::string& file, const std::string& scene_path) {
  return (folder_of(file) / fs::path(file).filename()).lexically_relative(folder_of(scene_path));
}

class Writer {
 public:
  explicit Writer(const Scene& scene, const std::string& path)
      : scene_(scene), path_(path), object_names_(object_names(scene)), character_names_(character_names(scene)) {}

  Result<std::string> write();

 private:
  template <class... Arguments>
  void put(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<Arguments>(arguments)...);
  }
  std::string number(double value) {
    if (!std::isfinite(value)) fail("a number of the scene is not finite, which no scene file can hold");
    return fmt::format("{}", value);
  }
  /// The shortest digits, unless the double that they are read as is beyond the largest float or so near the middle of
  /// two that it becomes the other one.
  std::string number(float value) {
    const std::string text = fmt::format("{}", value);
    const double read = std::strtod(text.c_str(), nullptr);
    const bool fits = std::fabs(read) <= double{std::numeric_limits<float>::max()};
    return fits && static_cast<float>(read) == value ? text : number(double{value});
  }
  template <class T>
  std::string vector(Vec3<T> v) {
    return fmt::format("[{}, {}, {}]", number(v.x), number(v.y), number(v.z));
  }
  std::string frame(const Frame& f) {
    return fmt::format(R"({{"point": {}, "x_axis": {}, "y_axis": {}, "z_axis": {}}})", vector(f.point),
                       vector(f.x_axis), vector(f.y_axis), vector(f.z_axis));
  }
  std::string placement(const BoxPlacement& box) { return ", \"box\": " + frame(box.box); }
  std::string placement(const FramePlacement& f) { return ", \"frame\": " + frame(f.frame); }
  std::string placement(const TransformPlacement& transform);
  std::string material(const Material& m) {
    return fmt::format(R"({{"ambient": {}, "diffuse": {}, "specular": {}, "shininess": {}, "emission": {}}})",
                       vector(m.ambient), vector(m.diffuse), vector(m.specular), number(m.shininess),
                       vector(m.emission));
  }
  std::string rotation(const Rotation& r) {
    return fmt::format(R"({{"axis": {}, "degrees": {}}})", vector(r.axis), number(r.degrees));
  }
  /// ", "name": value" for a field that is given.
  std::string field(const char* name, const std::optional<double>& value) {
    return value ? fmt::format(", \"{}\": {}", name, number(*value)) : "";
  }
  template <class T>
  std::string field(const char* name, const std::optional<Vec3<T>>& value) {
    return value ? fmt::format(", \"{}\": {}", name, vector(*value)) : "";
  }
  std::string fields(const CameraKey& k) {
    return field("position", k.position) + field("target", k.target) + field("up", k.up) +
           field("vertical_fov", k.vertical_fov_degrees);
  }
  std::string fields(const LightKey& k) {
    return field("position", k.position) + field("direction", k.direction) + field("colour", k.colour);
  }
  std::string fields(const TransformKey& k) {
    return field("translate", k.translate) + (k.rotate ? ", \"rotate\": " + rotation(*k.rotate) : "") +
           field("scale", k.scale);
  }
  template <class Moving>
  std::string motion(const Moving& moving);
  void put_light(const Light& light);
  const std::string& name_of(const SceneObject& object) const {
    return object_names_[static_cast<size_t>(&object - scene_.objects.data())];
  }
  void put_objects();
  void put_object(const SceneObject& object);
  void put_character(const Character& character);
  void put_part(const Part& part);
  /// `one` for each of `items`, one a line behind `indent`.
  template <class Items, class One>
  void put_list(const Items& items, const char* indent, const One& one) {
    const char* before = "";
    for (const auto& item : items) {
      put("{}\n{}", std::exchange(before, ","), indent);
      one(item);
    }
  }

  void fail(std::string what) {
    if (!error_) error_ = Error{ErrorClass::scene, path_, std::move(what)};
  }

  const Scene& scene_;
  const std::string& path_;
  const std::vector<std::string> object_names_;
  const std::vector<std::string> character_names_;
  std::string out_;
  std::optional<Error> error_;
};

/// As members that follow others; nothing for what is by default.
std::string Writer::placement(const TransformPlacement& t) {
  const TransformPlacement standard;
  std::string out;
  if (t.translate != standard.translate) out += ", \"translate\": " + vector(t.translate);
  if (t.rotate_axis != standard.rotate_axis || t.rotate_degrees != 0) {
    out += ", \"rotate\": " + rotation({t.rotate_axis, t.rotate_degrees});
  }
  if (t.scale != standard.scale) out += ", \"scale\": " + vector(t.scale);
  return out + motion(t);
}

/// Keys and how they are joined, as members that follow others.
template <class Moving>
std::string Writer::motion(const Moving& moving) {
  std::string out;
  for (const auto& key : moving.keys) {
    out += fmt::format(R"({}{{"frame": {}{}}})", out.empty() ? ", \"keys\": [" : ", ", number(key.frame), fields(key));
  }
  if (!out.empty()) out += "]";
  if (moving.interpolation == Interpolation::smooth) out += ", \"interpolation\": \"smooth\"";
  return out;
}

void Writer::put_light(const Light& light) {
  const bool has_position = light.kind != LightKind::directional, has_direction = light.kind != LightKind::point;
  put(R"({{"kind": "{}")", !has_position ? "directional" : has_direction ? "spot" : "point");
  if (has_position) put(", \"position\": {}", vector(light.position));
  if (has_direction) put(", \"direction\": {}", vector(light.direction));
  put(", \"colour\": {}", vector(light.colour));
  if (has_position && has_direction) {
    put(R"(, "inner_angle": {}, "outer_angle": {})", number(light.inner_degrees), number(light.outer_degrees));
  }
  if (has_position && light.falloff == Falloff::inverse_square) put(R"(, "falloff": "inverse_square")");
  if (has_position && std::isfinite(light.reach)) put(", \"reach\": {}", number(light.reach));
  put("{}}}", motion(light));
}

void Writer::put_objects() {
  std::vector<const SceneObject*> listed;
  for (const SceneObject& object : scene_.objects) {
    const bool in_library = !scene_.library.empty() && object.file == library_file(scene_.library, object.name) &&
                            name_of(object) == object.name;
    if (!in_library) listed.push_back(&object);
  }
  if (!scene_.library.empty()) {
    const std::string folder = folder_of(fs::path(scene_.library) / "").lexically_relative(folder_of(path_)).string();
    if (folder.empty() || clean_text(folder) != folder) {
      fail("the name of the library's folder cannot be in a scene file: rename it");
    }
    put("  \"library\": {},\n", json_string(folder));
    if (listed.empty()) return;
  }
  put("  \"objects\": [");
  put_list(listed, "    ", [&](const SceneObject* object) { put_object(*object); });
  put("\n  ],\n");
}

void Writer::put_object(const SceneObject& object) {
  const std::string& name = name_of(object);
  const std::string file = relative_file(object.file, path_).string();
  if (file.empty() || clean_text(file) != file) {
    fail(fmt::format("the file name of object '{}' cannot be in a scene file: rename it", name));
  }
  put(R"({{"name": {}, "file": {}}})", json_string(name), json_string(file));
}

void Writer::put_part(const Part& part) {
  put("{{");
  if (!part.name.empty()) put("\"name\": {}, ", json_string(clean_text(part.name)));
  const std::string placed = part.character ? "\"character\": " + json_string(character_names_[*part.character])
                                            : "\"object\": " + json_string(object_names_[part.object]);
  put("{}{}", placed, std::visit([&](const auto& p) { return placement(p); }, part.placement));
  if (part.sides) put(", \"sides\": \"{}\"", *part.sides == Sides::front ? "front" : "both");
  if (part.material) put(", \"material\": {}", material(*part.material));
  put("}}");
}

void Writer::put_character(const Character& character) {
  const std::string& name = character_names_[static_cast<size_t>(&character - scene_.characters.data())];
  std::string before;  // members, each behind a comma
  if (!name.empty()) before += ", \"name\": " + json_string(name);
  if (!character.shown) before += ", \"shown\": false";
  before += std::visit([&](const auto& p) { return placement(p); }, character.placement);
  put("{{{}{}\"parts\": [", before.substr(before.empty() ? 0 : 2), before.empty() ? "" : ", ");
  put_list(character.parts, "      ", [&](const Part& part) { put_part(part); });
  put("\n    ]}}");
}

Result<std::string> Writer::write() {
  put("  \"film\": {{\"width\": {}, \"height\": {}}},\n", scene_.film.width, scene_.film.height);
  const Camera& camera = scene_.camera;
  put("  \"camera\": {{\"position\": {}, \"target\": {}, \"up\": {}, \"vertical_fov\": {}{}}},\n",
      vector(camera.position), vector(camera.target), vector(camera.up), number(camera.vertical_fov_degrees),
      motion(camera));
  put("  \"background\": {},\n  \"ambient\": {},\n  \"lights\": [", vector(scene_.background), vector(scene_.ambient));
  put_list(scene_.lights, "    ", [&](const Light& light) { put_light(light); });
  put("{}],\n", scene_.lights.empty() ? "" : "\n  ");
  put_objects();
  put("  \"characters\": [");
  put_list(scene_.characters, "    ", [&](const Character& character) { put_character(character); });
  put("\n  ]\n}}\n");
  if (error_) return *error_;
  return head_of(out_) + out_;
}

}  // namespace

Result<void> write_scene(const Scene& scene, const std::string& path) {
  const Result<std::string> text = Writer(scene, path).write();
  if (!text) return text.error();
  return write_file(path, *text);
}

bool is_as_written(const std::string& path) {
  const auto file = MappedFile::open(path);
  if (!file) return false;
  const std::string_view text(reinterpret_cast<const char*>(file->bytes().data()), file->bytes().size());
  const size_t length = head_of("").size();
  return text.size() >= length && text.substr(0, length) == head_of(text.substr(length));
}

}  // namespace kd::scene
