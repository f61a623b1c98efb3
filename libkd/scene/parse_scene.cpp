#include "scene/parse_scene.h"

#include <cstdio>
#include <new>
#include <string_view>

#include <flatbuffers/idl.h>
#include <flatbuffers/reflection_generated.h>
#include <fmt/format.h>

#include "scene/json_locate.h"
#include "scene/scene_reader.h"
#include "scene_bfbs_generated.h"
#include "sys/mapped_file.h"

namespace kd::scene {

const reflection::Schema& scene_schema() { return *reflection::GetSchema(scene_fb::SceneBinarySchema::data()); }

std::string place_in_file(const std::string& path, Position at) {
  return fmt::format("{}:{}:{}", path, at.line, at.column);
}

namespace {

/// FlatBuffers' "line: column: error: text" as an Error of ours.
Error parser_error(const std::string& message, const std::string& path) {
  Position at;
  int length = 0;
  std::sscanf(message.c_str(), "%d: %d: error: %n", &at.line, &at.column, &length);
  return {ErrorClass::scene, place_in_file(path, at), "not valid JSON: " + message.substr(static_cast<size_t>(length))};
}

Result<Scene> parse(std::string_view json, const std::string& path) {
  if (json.size() > kMaxSceneBytes) {
    return Error{ErrorClass::scene, place_in_file(path, {}),
                 fmt::format("a scene has at most {} bytes", kMaxSceneBytes)};
  }
  TableLines lines;
  const auto fault = locate_fault(json, scene_schema(), [&](const JsonValue& v) {
    if (v.table == "kd.scene_fb.Part") lines.parts.push_back(v.at.line);
    if (v.table == "kd.scene_fb.Character") lines.characters.push_back(v.at.line);
  });
  if (fault) return Error{ErrorClass::scene, place_in_file(path, fault->at), fault->what};

  flatbuffers::IDLOptions options;
  options.strict_json = true;
  flatbuffers::Parser parser(options);
  const bool parsed = parser.Deserialize(&scene_schema()) && parser.ParseJson(std::string(json).c_str());
  if (!parsed) return parser_error(parser.error_, path);
  const auto& source = *flatbuffers::GetRoot<scene_fb::Scene>(parser.builder_.GetBufferPointer());
  return Reader(json, path, lines).read(source);
}

/// Where the scene cannot be read, it is asked for first whether it could be without overrides, then with one more
/// each.
Result<Scene> parse_changed(std::string_view json, const std::string& path, std::span<const Override> overrides) {
  if (json.size() > kMaxSceneBytes || locate_fault(json, scene_schema())) return parse(json, path);
  const auto changed = apply_overrides(std::string(json), overrides);
  if (!changed) return changed.error();
  auto scene = parse(*changed, path);
  if (scene) return scene;
  if (auto unchanged = parse(json, path); !unchanged) return unchanged;
  for (size_t count = 1; count <= overrides.size(); ++count) {
    const auto part = parse(*apply_overrides(std::string(json), overrides.first(count)), path);
    const Override& last = overrides[count - 1];
    if (!part) return Error{ErrorClass::usage, fmt::format("{}={}", last.path, last.value), part.error().what};
  }
  return scene;
}

}  // namespace

Result<Scene> parse_scene(std::string_view json, const std::string& path) { return parse_scene(json, path, {}); }

Result<Scene> parse_scene(std::string_view json, const std::string& path, std::span<const Override> overrides) {
  try {
    return overrides.empty() ? parse(json, path) : parse_changed(json, path, overrides);
  } catch (const std::bad_alloc&) {
    return Error{ErrorClass::resource, path, "not enough memory to read the scene"};
  }
}

Result<Scene> read_scene(const std::string& path, std::span<const Override> overrides) {
  const auto file = MappedFile::open(path);
  if (!file) return file.error();
  const auto bytes = file->bytes();
  return parse_scene({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path, overrides);
}

}  // namespace kd::scene
