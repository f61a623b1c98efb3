// The characters of a scene file, and what their parts place.
#include <fmt/format.h>

#include "scene/nesting.h"
#include "scene/scene_reader.h"

namespace kd::scene {

namespace {

/// An error lists the names that there are if they are no more than these.
constexpr size_t kMaxListedNames = 8;
constexpr uint32_t kAmbiguous = 0xffffffffu;

Frame to_frame(const scene_fb::Frame& f) {
  return {to_vec3d(*f.point()), to_vec3d(*f.x_axis()), to_vec3d(*f.y_axis()), to_vec3d(*f.z_axis())};
}

/// "the scene has a, b", for one that asked for another; `kind` in the plural.
template <class Named>
std::string known_names(const std::vector<Named>& all, const char* kind) {
  if (all.size() > kMaxListedNames) return fmt::format("none of the scene's {} {} has this name", all.size(), kind);
  std::string known;
  for (const Named& one : all) known += (known.empty() ? "the scene has " : ", ") + one.name;
  return known;
}

}  // namespace

void Reader::name_characters(const scene_fb::Scene& source) {
  uint32_t index = 0;
  for (const scene_fb::Character* character : *source.characters()) {
    const auto at = index++;
    if (!character->name() || character->name()->size() == 0) continue;
    const auto [entry, is_new] = character_index_.emplace(character->name()->str(), at);
    if (!is_new) entry->second = kAmbiguous;
  }
}

Character Reader::read_character(const scene_fb::Character& source, const Place& at) {
  Character character;
  character.name = read_text(source.name(), at + ".name");
  character.line = lines_.characters[scene_.characters.size()];
  character.shown = source.shown();
  character.placement = read_placement(source, at);
  character.parts.reserve(source.parts()->size());
  for (const scene_fb::Part* part : *source.parts()) {
    character.parts.push_back(read_part(*part, Place{".parts", &at, character.parts.size()}));
  }
  if (character.parts.empty()) fail(at + ".parts", "the character has no parts: it needs at least one");
  return character;
}

Part Reader::read_part(const scene_fb::Part& source, const Place& at) {
  Part part;
  part.line = lines_.parts[parts_read_++];
  part.name = read_text(source.name(), at + ".name");
  read_placed(source, at, part);
  if (source.box()) {
    exclude(source.frame(), "frame", "box", at);
    exclude_transform(source, "box", at);
    part.placement = BoxPlacement{to_frame(*source.box())};
  } else {
    std::visit([&](auto&& placement) { part.placement = std::move(placement); }, read_placement(source, at));
  }
  if (source.sides()) part.sides = *source.sides() == scene_fb::Sides::front ? Sides::front : Sides::both;
  if (source.material()) part.material = read_material(*source.material(), at + ".material");
  return part;
}

/// The object or the character that a part places.
void Reader::read_placed(const scene_fb::Part& source, const Place& at, Part& part) {
  if (source.character()) {
    exclude(source.object(), "object", "character", at);
    exclude(source.box(), "box", "character", at);
    part.character = find_character(*source.character(), at + ".character");
  } else if (source.object()) {
    part.object = find_object(*source.object(), at + ".object");
  } else {
    fail(at, fmt::format("'{}' lacks 'object', or 'character'", at.last()));
  }
}

template <class Source>
void Reader::exclude_transform(const Source& source, const char* given, const Place& at) {
  exclude(source.translate(), "translate", given, at);
  exclude(source.rotate(), "rotate", given, at);
  exclude(source.scale(), "scale", given, at);
  exclude(source.keys(), "keys", given, at);
}

template <class Source>
CharacterPlacement Reader::read_placement(const Source& source, const Place& at) {
  if (!source.frame()) return read_transform(source, at);
  exclude_transform(source, "frame", at);
  return FramePlacement{to_frame(*source.frame())};
}

template <class Source>
TransformPlacement Reader::read_transform(const Source& source, const Place& at) {
  TransformPlacement placement;
  if (source.translate()) placement.translate = to_vec3d(*source.translate());
  if (source.scale()) placement.scale = read_scale(*source.scale(), at + ".scale");
  if (source.rotate()) {
    const Rotation rotation = read_rotation(*source.rotate(), at + ".rotate");
    placement.rotate_axis = rotation.axis;
    placement.rotate_degrees = rotation.degrees;
  }
  placement.interpolation = to_interpolation(source.interpolation());
  placement.keys = read_keys<TransformKey>(
      source.keys(), at, [&](const scene_fb::TransformKey& k, const Place& at_key, TransformKey& key) {
        if (k.translate()) key.translate = to_vec3d(*k.translate());
        if (k.rotate()) key.rotate = read_rotation(*k.rotate(), at_key + ".rotate");
        if (k.scale()) key.scale = read_scale(*k.scale(), at_key + ".scale");
      });
  return placement;
}

Vec3d Reader::read_scale(const scene_fb::Vec3& source, const Place& at) {
  const Vec3d scale = to_vec3d(source);
  if (scale.x == 0 || scale.y == 0 || scale.z == 0) fail(at, "no component of 'scale' may be zero");
  return scale;
}

Rotation Reader::read_rotation(const scene_fb::Rotation& source, const Place& at) {
  const Rotation rotation{to_vec3d(*source.axis()), source.degrees().value_or(0)};
  if (rotation.axis == Vec3d{0, 0, 0}) fail(at + ".axis", "the rotation's 'axis' must not be zero");
  if (!source.degrees()) fail(at, "the rotation lacks 'degrees'");
  return rotation;
}

uint32_t Reader::find_object(const flatbuffers::String& name, const Place& at) {
  const auto found = object_index_.find(name.str());
  if (found != object_index_.end()) return found->second;
  if (!scene_.library.empty()) {
    const auto index = static_cast<uint32_t>(scene_.objects.size());
    const std::string clean = read_name(name, at);
    object_index_.emplace(clean, index);
    scene_.objects.push_back({clean, library_file(scene_.library, clean)});
    return index;
  }
  fail(at, fmt::format("there is no object '{}': {}", read_text(&name, at), known_names(scene_.objects, "objects")));
  return 0;
}

uint32_t Reader::find_character(const flatbuffers::String& name, const Place& at) {
  const auto found = character_index_.find(name.str());
  if (found == character_index_.end()) {
    fail(at, fmt::format("there is no character '{}' in the scene", read_text(&name, at)));
  } else if (found->second == kAmbiguous) {
    fail(at, fmt::format("there are several characters '{}': rename all but one", name.str()));
  } else {
    return found->second;
  }
  return 0;
}

void Reader::check_nesting() {
  const InstanceCounts counts = count_instances(scene_);
  if (!counts.fault) return;
  const NestingFault& fault = *counts.fault;
  const bool places_character = scene_.characters[fault.character].parts[fault.part].character.has_value();
  fail(fmt::format("characters[{}].parts[{}]{}", fault.character, fault.part, places_character ? ".character" : ""),
       fault.what);
}

}  // namespace kd::scene
