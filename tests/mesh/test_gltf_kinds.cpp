// glTF: values of other kinds than the format says, wherever they are read, are refused and said where.
#include <doctest/doctest.h>

#include <set>

#include <nlohmann/json.hpp>

#include "gltf_texts.h"
#include "mesh/asset.h"
#include "support/temp_folder.h"

using namespace kd;
using namespace kd::mesh;
using namespace kd::test;

namespace {

/// The message of a file that must be refused; one line. Empty if it is read.
std::string fault(const std::string& contents) {
  const TempFolder folder;
  const auto asset = read_asset(folder.write("a.gltf", contents), {}, Split::none);
  if (asset) return "";
  CHECK(asset.error().error_class == ErrorClass::mesh);
  return asset.error().line();
}

bool mentions(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("gltf: a value of another kind than glTF says is refused, with its place") {
  using Json = nlohmann::json;
  Json full = Json::parse(
      square_gltf(R"(, "scene": 0, "scenes": [{"nodes": [0, 1]}], "extensionsRequired": ["KHR_lights_punctual"],
"materials": [{"name": "m", "pbrMetallicRoughness":
 {"baseColorFactor": [1, 0.5, 0, 1], "metallicFactor": 0.5, "roughnessFactor": 0.5}}],
"cameras": [{"type": "perspective", "perspective": {"yfov": 1.5, "znear": 0.5, "zfar": 9.5, "aspectRatio": 1.5}},
 {"type": "orthographic", "orthographic": {"xmag": 1.5, "ymag": 1.5, "znear": 0.5, "zfar": 1.5}}],
"extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "color": [1, 0.5, 0.5], "intensity": 8.5,
 "spot": {"innerConeAngle": 0.5, "outerConeAngle": 0.75}}]}})"));
  full["nodes"] =
      Json::parse(R"([{"name": "n", "mesh": 0, "children": [2], "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]},
{"camera": 0, "translation": [0, 0, 1], "rotation": [0, 0, 0, 1], "scale": [1, 1, 1]},
{"extensions": {"KHR_lights_punctual": {"light": 0}}}])");
  full["meshes"][0]["primitives"][0].update(Json::parse(R"({"mode": 4, "material": 0, "targets": [{"POSITION": 0}]})"));
  full["accessors"][0].update(Json::parse(R"({"byteOffset": 0, "normalized": false, "sparse": {"count": 1,
"indices": {"bufferView": 2, "byteOffset": 0, "componentType": 5123}, "values": {"bufferView": 0, "byteOffset": 0}}})"));
  full["bufferViews"][0].update(Json::parse(R"({"byteOffset": 0, "byteStride": 12})"));
  REQUIRE(fault(full.dump()).empty());

  std::set<std::string> pointers;  // of all values, but for the root
  const Json flat = full.flatten();
  for (const auto& leaf : flat.items()) {
    for (Json::json_pointer at(leaf.key()); !at.empty(); at = at.parent_pointer()) pointers.insert(at.to_string());
  }
  CHECK(pointers.size() > 120);
  // These are whole in glTF; other numbers may be whole or not.
  const std::set<std::string> whole_numbers{
      "buffer",  "bufferView", "byteLength", "byteOffset", "byteStride", "camera", "componentType", "count",
      "indices", "light",      "material",   "mesh",       "mode",       "NORMAL", "POSITION",      "scene"};
  const Json others = Json::parse(R"([null, true, 0, -1, 0.5, 1e300, "x", [], [[]], {}, {"a": [1]}])");
  for (const std::string& pointer : pointers) {
    const Json::json_pointer at(pointer);
    const bool is_whole = full[at].is_number() && whole_numbers.contains(at.back());
    const std::string wanted = pointer.starts_with("/asset") ? "asset.version" : fmt::format("'{}' must be", pointer);
    for (const Json& other : others) {
      const bool is_wrong_number = is_whole && other.is_number() && other != 0;
      const bool is_same_kind = full[at].type() == other.type() || (full[at].is_number() && other.is_number());
      if (is_same_kind && !is_wrong_number) continue;
      Json changed = full;
      changed[at] = other;
      const std::string line = fault(changed.dump());
      CHECK_MESSAGE(mentions(line, wanted), fmt::format("{} in {}: {}", other.dump(), wanted, line));
    }
  }
}

TEST_CASE("gltf: what is not used may be of any kind") {
  const std::string odd = R"(, "images": 3, "samplers": "x", "extensionsUsed": [1], "programs": [{"attributes": ["a"]}],
"extensions": {"EXT_x": {"mesh": -1, "count": "x"}}, "materials": [{"normalTexture": {"scale": "x", "index": -1}}])";
  CHECK(fault(square_gltf(odd)).empty());
}

TEST_CASE("gltf: Draco's compression is said, required or not, and passed over where the same is there without it") {
  const std::string draco = R"("indices": 2, "extensions": {"KHR_draco_mesh_compression": {"bufferView": 0}})";
  const std::string with_both = replaced(square_gltf(), R"("indices": 2)", draco);
  CHECK(fault(with_both).empty());
  CHECK(
      mentions(fault(replaced(with_both, R"({"bufferView": 0, "comp)", R"({"comp)")), "'KHR_draco_mesh_compression'"));
}
