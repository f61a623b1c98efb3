#include "scene/parse_scene.h"

#include <cstdio>
#include <filesystem>
#include <limits>
#include <new>
#include <string_view>
#include <unordered_map>

#include <flatbuffers/idl.h>
#include <flatbuffers/reflection_generated.h>
#include <fmt/format.h>

#include "scene/json_locate.h"
#include "scene_bfbs_generated.h"
#include "scene_generated.h"
#include "sys/mapped_file.h"

namespace kd::scene {

namespace {

/// Below this sine of the angle between them, `up` counts as parallel to the view direction.
constexpr double kParallelSine = 1e-6;
/// An error lists the objects' names if there are no more than these.
constexpr size_t kMaxListedNames = 8;

const reflection::Schema& schema() { return *reflection::GetSchema(scene_fb::SceneBinarySchema::data()); }

std::string place(const std::string& path, Position at) { return fmt::format("{}:{}:{}", path, at.line, at.column); }

/// Whether a colour's component or an exponent is in range.
bool fits_float(double v) { return v >= 0 && v <= double{std::numeric_limits<float>::max()}; }

Vec3d to_vec3d(const scene_fb::Vec3& v) { return {v.x(), v.y(), v.z()}; }

Frame to_frame(const scene_fb::Frame& f) {
  return {to_vec3d(*f.point()), to_vec3d(*f.x_axis()), to_vec3d(*f.y_axis()), to_vec3d(*f.z_axis())};
}

/// Turns the parsed tables into a Scene and checks what the schema cannot say. A failed check records an error, the
/// first one only, and reading goes on with whatever is there; `read` then returns the error.
class Reader {
 public:
  Reader(std::string_view json, const std::string& path, const std::vector<int>& part_lines)
      : json_(json), path_(path), part_lines_(part_lines) {}

  Result<Scene> read(const scene_fb::Scene& source);

 private:
  void read_film(const scene_fb::Film& source);
  void read_camera(const scene_fb::Camera& source);
  Light read_light(const scene_fb::Light& source, const std::string& at);
  SceneObject read_object(const scene_fb::Object& source, const std::string& at);
  Character read_character(const scene_fb::Character& source, const std::string& at);
  Part read_part(const scene_fb::Part& source, const std::string& at);
  Placement read_placement(const scene_fb::Part& source, const std::string& at);
  TransformPlacement read_transform(const scene_fb::Part& source, const std::string& at);
  Material read_material(const scene_fb::Material& source, const std::string& at);
  uint32_t find_object(const flatbuffers::String& name, const std::string& at);

  std::string read_text(const flatbuffers::String* source, const std::string& at);
  std::string read_name(const flatbuffers::String& source, const std::string& at);
  Vec3f read_colour(const scene_fb::Vec3* source, Vec3f otherwise, const std::string& at);

  /// `at`: the faulty value's path in the JSON, such as "characters[0].parts[2].scale".
  void fail(const std::string& at, std::string what) {
    if (!error_) error_ = Error{ErrorClass::scene, place(path_, locate(json_, schema(), at)), std::move(what)};
  }

  std::string_view json_;
  const std::string& path_;
  const std::vector<int>& part_lines_;  // of every part, in the order of the text
  size_t parts_read_ = 0;
  Scene scene_;
  std::unordered_map<std::string, uint32_t> object_index_;
  std::optional<Error> error_;
};

Result<Scene> Reader::read(const scene_fb::Scene& source) {
  scene_.path = path_;
  if (source.film()) read_film(*source.film());
  read_camera(*source.camera());
  scene_.background = read_colour(source.background(), scene_.background, "background");
  scene_.ambient = read_colour(source.ambient(), scene_.ambient, "ambient");
  if (source.lights()) {
    for (const scene_fb::Light* light : *source.lights()) {
      scene_.lights.push_back(read_light(*light, fmt::format("lights[{}]", scene_.lights.size())));
    }
  }
  for (const scene_fb::Object* object : *source.objects()) {
    const std::string at = fmt::format("objects[{}]", scene_.objects.size());
    scene_.objects.push_back(read_object(*object, at));
  }
  if (scene_.objects.empty()) fail("objects", "the scene has no objects: it needs at least one");
  for (const scene_fb::Character* character : *source.characters()) {
    const std::string at = fmt::format("characters[{}]", scene_.characters.size());
    scene_.characters.push_back(read_character(*character, at));
  }
  if (scene_.characters.empty()) fail("characters", "the scene has no characters: it needs at least one");
  if (error_) return *error_;
  return std::move(scene_);
}

void Reader::read_film(const scene_fb::Film& source) {
  scene_.film = {source.width(), source.height()};
  const auto check_side = [&](const char* name, uint32_t pixels) {
    if (pixels >= 1 && pixels <= kMaxFilmSide) return;
    fail(fmt::format("film.{}", name), fmt::format("the film's {} must be from 1 to {} pixels", name, kMaxFilmSide));
  };
  check_side("width", source.width());
  check_side("height", source.height());
  if (uint64_t{source.width()} * source.height() > kMaxFilmPixels) {
    fail("film", fmt::format("the film has more than {} pixels: reduce its width or height", kMaxFilmPixels));
  }
}

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

SceneObject Reader::read_object(const scene_fb::Object& source, const std::string& at) {
  SceneObject object;
  object.name = read_name(*source.name(), at + ".name");
  const std::filesystem::path file = read_name(*source.file(), at + ".file");
  object.file = (std::filesystem::path(path_).parent_path() / file).string();
  const auto index = static_cast<uint32_t>(scene_.objects.size());
  if (!object_index_.emplace(object.name, index).second) {
    fail(at + ".name", fmt::format("there are two objects '{}': rename one", object.name));
  }
  return object;
}

Character Reader::read_character(const scene_fb::Character& source, const std::string& at) {
  Character character;
  character.name = read_text(source.name(), at + ".name");
  character.parts.reserve(source.parts()->size());
  for (const scene_fb::Part* part : *source.parts()) {
    character.parts.push_back(read_part(*part, fmt::format("{}.parts[{}]", at, character.parts.size())));
  }
  if (character.parts.empty()) fail(at + ".parts", "the character has no parts: it needs at least one");
  return character;
}

Part Reader::read_part(const scene_fb::Part& source, const std::string& at) {
  Part part;
  part.line = part_lines_[parts_read_++];
  part.name = read_text(source.name(), at + ".name");
  part.object = find_object(*source.object(), at + ".object");
  part.placement = read_placement(source, at);
  if (source.material()) part.material = read_material(*source.material(), at + ".material");
  return part;
}

Placement Reader::read_placement(const scene_fb::Part& source, const std::string& at) {
  if (!source.box() && !source.frame()) return read_transform(source, at);
  const char* given = source.box() ? "box" : "frame";
  const auto exclude = [&](const void* field, const char* name) {
    if (!field) return;
    fail(fmt::format("{}.{}", at, name), fmt::format("'{}' does not go with '{}': keep one of them", name, given));
  };
  exclude(source.translate(), "translate");
  exclude(source.rotate(), "rotate");
  exclude(source.scale(), "scale");
  if (!source.box()) return FramePlacement{to_frame(*source.frame())};
  exclude(source.frame(), "frame");
  return BoxPlacement{to_frame(*source.box())};
}

TransformPlacement Reader::read_transform(const scene_fb::Part& source, const std::string& at) {
  TransformPlacement placement;
  if (source.translate()) placement.translate = to_vec3d(*source.translate());
  if (source.scale()) placement.scale = to_vec3d(*source.scale());
  if (placement.scale.x == 0 || placement.scale.y == 0 || placement.scale.z == 0) {
    fail(at + ".scale", "no component of 'scale' may be zero");
  }
  if (!source.rotate()) return placement;
  placement.rotate_axis = to_vec3d(*source.rotate()->axis());
  if (placement.rotate_axis == Vec3d{0, 0, 0}) fail(at + ".rotate.axis", "the rotation's 'axis' must not be zero");
  if (!source.rotate()->degrees()) fail(at + ".rotate", "the rotation lacks 'degrees'");
  placement.rotate_degrees = source.rotate()->degrees().value_or(0);
  return placement;
}

Material Reader::read_material(const scene_fb::Material& source, const std::string& at) {
  Material material;
  material.ambient = read_colour(source.ambient(), material.ambient, at + ".ambient");
  material.diffuse = read_colour(source.diffuse(), material.diffuse, at + ".diffuse");
  material.specular = read_colour(source.specular(), material.specular, at + ".specular");
  if (fits_float(source.shininess())) {
    material.shininess = static_cast<float>(source.shininess());
  } else {
    fail(at + ".shininess", "'shininess' must be from 0 to 3.4e38");
  }
  return material;
}

uint32_t Reader::find_object(const flatbuffers::String& name, const std::string& at) {
  const auto found = object_index_.find(name.str());
  if (found != object_index_.end()) return found->second;
  std::string known;
  for (const SceneObject& object : scene_.objects) known += (known.empty() ? "the scene has " : ", ") + object.name;
  if (scene_.objects.size() > kMaxListedNames) {
    known = fmt::format("none of the scene's {} objects has this name", scene_.objects.size());
  }
  fail(at, fmt::format("there is no object '{}': {}", read_text(&name, at), known));
  return 0;
}

/// A string for people: error lines repeat it, so that it must stay on one.
std::string Reader::read_text(const flatbuffers::String* source, const std::string& at) {
  if (!source) return {};
  for (const char c : source->string_view()) {
    if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) fail(at, "a name must not hold control characters");
  }
  return source->str();
}

std::string Reader::read_name(const flatbuffers::String& source, const std::string& at) {
  if (source.size() == 0) fail(at, fmt::format("'{}' must not be empty", at.substr(at.rfind('.') + 1)));
  return read_text(&source, at);
}

Vec3f Reader::read_colour(const scene_fb::Vec3* source, Vec3f otherwise, const std::string& at) {
  if (!source) return otherwise;
  if (!fits_float(source->x()) || !fits_float(source->y()) || !fits_float(source->z())) {
    fail(at, "the components of a colour must be from 0 to 3.4e38");
    return otherwise;
  }
  return vec_cast<float>(to_vec3d(*source));
}

/// FlatBuffers' "line: column: error: text" as an Error of ours.
Error parser_error(const std::string& message, const std::string& path) {
  Position at;
  int length = 0;
  std::sscanf(message.c_str(), "%d: %d: error: %n", &at.line, &at.column, &length);
  return {ErrorClass::scene, place(path, at), "not valid JSON: " + message.substr(static_cast<size_t>(length))};
}

Result<Scene> parse(std::string_view json, const std::string& path) {
  if (json.size() > kMaxSceneBytes) {
    return Error{ErrorClass::scene, place(path, {}), fmt::format("a scene has at most {} bytes", kMaxSceneBytes)};
  }
  std::vector<int> part_lines;
  const auto fault = locate_fault(json, schema(), [&](const JsonValue& v) {
    if (v.table == "kd.scene_fb.Part") part_lines.push_back(v.at.line);
  });
  if (fault) return Error{ErrorClass::scene, place(path, fault->at), fault->what};

  flatbuffers::IDLOptions options;
  options.strict_json = true;
  flatbuffers::Parser parser(options);
  const bool parsed = parser.Deserialize(&schema()) && parser.ParseJson(std::string(json).c_str());
  if (!parsed) return parser_error(parser.error_, path);
  const auto& source = *flatbuffers::GetRoot<scene_fb::Scene>(parser.builder_.GetBufferPointer());
  return Reader(json, path, part_lines).read(source);
}

}  // namespace

Result<Scene> parse_scene(std::string_view json, const std::string& path) {
  try {
    return parse(json, path);
  } catch (const std::bad_alloc&) {
    return Error{ErrorClass::resource, path, "not enough memory to read the scene"};
  }
}

Result<Scene> read_scene(const std::string& path) {
  const auto file = MappedFile::open(path);
  if (!file) return file.error();
  const auto bytes = file->bytes();
  return parse_scene({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path);
}

}  // namespace kd::scene
