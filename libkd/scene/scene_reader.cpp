#include "scene/scene_reader.h"

#include <filesystem>
#include <limits>

#include <fmt/format.h>

namespace kd::scene {

bool fits_float(double v) { return v >= 0 && v <= double{std::numeric_limits<float>::max()}; }

std::string Place::last() const {
  const std::string_view plain = name.starts_with('.') ? name.substr(1) : name;
  return index == kNoIndex ? std::string(plain) : fmt::format("{}[{}]", plain, index);
}

std::string Place::text() const {
  if (!outer) return last();
  return fmt::format("{}.{}", outer->text(), last());
}

Reader::Reader(std::string_view json, const std::string& path, const TableLines& lines)
    : json_(json), path_(path), lines_(lines), folder_((std::filesystem::path(path).parent_path() / "").string()) {}

Result<Scene> Reader::read(const scene_fb::Scene& source) {
  scene_.path = path_;
  if (source.film()) read_film(*source.film());
  read_camera(*source.camera());
  scene_.background = read_colour(source.background(), scene_.background, Place{"background"});
  scene_.ambient = read_colour(source.ambient(), scene_.ambient, Place{"ambient"});
  if (source.lights()) {
    for (const scene_fb::Light* light : *source.lights()) {
      scene_.lights.push_back(read_light(*light, Place{"lights", nullptr, scene_.lights.size()}));
    }
  }
  read_objects(source);
  name_characters(source);
  for (const scene_fb::Character* character : *source.characters()) {
    const Place at{"characters", nullptr, scene_.characters.size()};
    scene_.characters.push_back(read_character(*character, at));
  }
  if (scene_.characters.empty()) fail("characters", "the scene has no characters: it needs at least one");
  if (!error_) check_nesting();
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

void Reader::read_objects(const scene_fb::Scene& source) {
  if (source.library()) scene_.library = from_folder(read_name(*source.library(), Place{"library"}));
  if (source.objects()) {
    for (const scene_fb::Object* object : *source.objects()) {
      const Place at{"objects", nullptr, scene_.objects.size()};
      scene_.objects.push_back(read_object(*object, at));
    }
  } else if (!source.library()) {
    fail("", "the scene lacks 'objects', or a 'library'");
  }
  if (scene_.objects.empty() && !source.library()) fail("objects", "the scene has no objects: it needs at least one");
}

SceneObject Reader::read_object(const scene_fb::Object& source, const Place& at) {
  SceneObject object;
  object.name = read_name(*source.name(), at + ".name");
  object.file = from_folder(read_name(*source.file(), at + ".file"));
  const auto index = static_cast<uint32_t>(scene_.objects.size());
  if (!object_index_.emplace(object.name, index).second) {
    fail(at + ".name", fmt::format("there are two objects '{}': rename one", object.name));
  }
  return object;
}

Material Reader::read_material(const scene_fb::Material& source, const Place& at) {
  Material material;
  material.ambient = read_colour(source.ambient(), material.ambient, at + ".ambient");
  material.diffuse = read_colour(source.diffuse(), material.diffuse, at + ".diffuse");
  material.specular = read_colour(source.specular(), material.specular, at + ".specular");
  material.emission = read_colour(source.emission(), material.emission, at + ".emission");
  if (fits_float(source.shininess())) {
    material.shininess = static_cast<float>(source.shininess());
  } else {
    fail(at + ".shininess", "'shininess' must be from 0 to 3.4e38");
  }
  return material;
}

double Reader::read_frame(std::optional<double> source, std::optional<double> before, const Place& at) {
  if (!source) fail(at, "the key lacks 'frame'");
  const double frame = source.value_or(0);
  if (!(frame >= -kMaxKeyFrame && frame <= kMaxKeyFrame)) fail(at + ".frame", "'frame' must be from -1e9 to 1e9");
  if (before && !(frame > *before)) {
    fail(at + ".frame", fmt::format("the frames of keys must increase, and {} does not follow {}", frame, *before));
  }
  return frame;
}

void Reader::exclude(const void* present, const char* name, const char* given, const Place& at) {
  if (!present) return;
  fail(fmt::format("{}.{}", at.text(), name), fmt::format("'{}' does not go with '{}': keep one of them", name, given));
}

/// A string for people: error lines repeat it, so that it must stay on one.
std::string Reader::read_text(const flatbuffers::String* source, const Place& at) {
  if (!source) return {};
  for (const char c : source->string_view()) {
    if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) fail(at, "a name must not hold control characters");
  }
  return source->str();
}

std::string Reader::read_name(const flatbuffers::String& source, const Place& at) {
  if (source.size() == 0) fail(at, fmt::format("'{}' must not be empty", at.last()));
  return read_text(&source, at);
}

Vec3f Reader::read_colour(const scene_fb::Vec3* source, Vec3f otherwise, const Place& at) {
  if (!source) return otherwise;
  if (!fits_float(source->x()) || !fits_float(source->y()) || !fits_float(source->z())) {
    fail(at, "the components of a colour must be from 0 to 3.4e38");
    return otherwise;
  }
  return vec_cast<float>(to_vec3d(*source));
}

}  // namespace kd::scene
