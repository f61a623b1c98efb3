// glTF: what a file says comes out, and what it says wrongly is refused, before anything is read or allocated for it.
#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>

#include "gltf_texts.h"
#include "mesh/asset.h"
#include "support/temp_folder.h"

using namespace kd;
using namespace kd::mesh;
using namespace kd::test;

namespace {

Result<Asset> read(const std::string& contents, const std::string& name = "a.gltf", Split split = Split::none) {
  const TempFolder folder;
  return read_asset(folder.write(name, contents), {}, split);
}

Asset sound(const Result<Asset>& asset) {
  REQUIRE_MESSAGE(asset, (asset ? "" : asset.error().line()));
  return *asset;
}

/// The message of a file that must be refused; one line.
std::string fault(const std::string& contents, const std::string& name = "a.gltf") {
  const auto asset = read(contents, name);
  REQUIRE_FALSE(asset);
  CHECK(asset.error().error_class == ErrorClass::mesh);
  const std::string line = asset.error().line();
  CHECK(line.find('\n') == std::string::npos);
  return line;
}

bool mentions(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// A file of one primitive: `bytes` in one buffer and view, and the rest as given.
std::string primitive_gltf(const std::string& bytes, const std::string& accessors, const std::string& primitive,
                           const std::string& view = "") {
  return fmt::format(
      R"({{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": {}, "uri": "{}"}}],
"bufferViews": [{{"buffer": 0, "byteLength": {}{}}}], "accessors": [{}], "meshes": [{{"primitives": [{}]}}]}})",
      bytes.size(), data_uri(bytes), bytes.size(), view, accessors, primitive);
}

using Triangles = std::vector<std::array<uint32_t, 3>>;

}  // namespace

TEST_CASE("gltf: a square, from text and from a container") {
  for (const bool binary : {false, true}) {
    const Asset asset =
        sound(binary ? read(glb(square_json(""), square_bytes()), "a.glb") : read(square_gltf(), "a.gltf"));
    REQUIRE(asset.meshes.size() == 1);
    CHECK(asset.meshes[0].name == "square");
    const Mesh& mesh = asset.meshes[0].mesh;
    CHECK(mesh.positions == std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    CHECK(mesh.triangles == Triangles{{0, 1, 2}, {0, 2, 3}});
    CHECK(mesh.normal_indices == Triangles{{0, 1, 2}, {0, 2, 3}});
    CHECK(mesh.normals[0] == Vec3f{0, 0, 1});
    CHECK(mesh.source_primitives == std::vector<uint32_t>{0, 1});
    CHECK(mesh.materials.empty());
    CHECK(asset.warnings.empty());
    CHECK(asset.is_plain_mesh());
  }
  const std::string extras = R"(, "extras": {"deep": [[[1]]], "mesh": -1, "scene": "x"})";
  CHECK(sound(read("\xEF\xBB\xBF" + square_gltf(extras), "A.GLTF")).meshes.size() == 1);
}

TEST_CASE("gltf: buffers in files beside it") {
  const TempFolder folder;
  const auto with_uri = [&](const std::string& uri) {
    return read_asset(folder.write("a.gltf", square_json(fmt::format(R"(, "uri": "{}")", uri))), {}, Split::none);
  };
  std::filesystem::create_directory(folder.file("sub dir"));
  folder.write("sub dir/b.bin", square_bytes() + "padding");
  CHECK(sound(with_uri("sub%20dir/b.bin")).meshes[0].mesh.triangles.size() == 2);
  CHECK(with_uri("none.bin").error().error_class == ErrorClass::missing);
  CHECK(mentions(with_uri("none.bin").error().line(), "none.bin"));
  folder.write("short.bin", "1234");
  CHECK(mentions(with_uri("short.bin").error().line(), "has 4 of its 108 bytes"));
  for (const std::string uri : {"../a.gltf", "sub dir/../../x", "%2e%2e/x", "/etc/passwd", "http://host/x", "file:///x",
                                "", "c:\\\\x", "x%00y"}) {
    CAPTURE(uri);
    const auto asset = with_uri(uri);
    REQUIRE_FALSE(asset);
    CHECK(mentions(asset.error().line(), "only read from files beside"));
  }
}

TEST_CASE("gltf: strips, fans, bare corners, and modes that are no surface") {
  const std::string bytes = raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0, 5, 5, 5});
  const std::string accessor = R"({"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3"})";
  const auto triangles = [&](int mode) {
    const auto asset =
        read(primitive_gltf(bytes, accessor, fmt::format(R"({{"attributes": {{"POSITION": 0}}, "mode": {}}})", mode)));
    return asset ? asset->meshes[0].mesh.triangles : Triangles{};
  };
  CHECK(triangles(4) == Triangles{{0, 1, 2}, {3, 4, 5}});
  // In order of first use: each triangle of a strip turns like the first.
  CHECK(triangles(5) == Triangles{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}});
  CHECK(triangles(6) == Triangles{{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 5, 2}});
  for (const int mode : {0, 1, 2, 3, 7}) {
    CHECK(triangles(mode).empty());
  }
  const auto mixed = read(primitive_gltf(
      bytes, accessor + R"(, {"bufferView": 0, "componentType": 5126, "count": 5, "type": "VEC3"})",
      R"({"attributes": {"POSITION": 0}, "mode": 1}, {"attributes": {"NORMAL": 0}}, {"attributes": {"POSITION": 1}})"));
  REQUIRE(mixed);
  CHECK(mixed->meshes[0].mesh.triangles.size() == 1);
  CHECK(mixed->meshes[0].name == "mesh_0");
  REQUIRE(mixed->warnings.size() == 4);
  CHECK(mentions(mixed->warnings[0], "1 primitive(s) of points or lines"));
  CHECK(mentions(mixed->warnings[1], "1 primitive(s) without positions"));
  CHECK(mentions(mixed->warnings[2], "2 index(es)"));
  CHECK(mentions(mixed->warnings[3], "no node places a mesh"));
}

TEST_CASE("gltf: every component type, stride and sparse elements") {
  const auto positions = [](const std::string& bytes, int type, const std::string& more, const std::string& view = "") {
    const auto asset = read(primitive_gltf(
        bytes, fmt::format(R"({{"bufferView": 0, "componentType": {}, "count": 3, "type": "VEC3"{}}})", type, more),
        R"({"attributes": {"POSITION": 0}})", view));
    return sound(asset).meshes[0].mesh.positions;
  };
  const std::string pad(1, '\0'), pads(2, '\0'), normalised = R"(, "normalized": true)";
  const std::string b = raw<int8_t>({-128, -127, 127}) + pad + raw<int8_t>({0, 64, 1}) + pad + raw<int8_t>({2, 3, 4});
  CHECK(positions(b, 5120, "", R"(, "byteStride": 4)") == std::vector<Vec3d>{{-128, -127, 127}, {0, 64, 1}, {2, 3, 4}});
  CHECK(positions(b, 5120, normalised, R"(, "byteStride": 4)")[0] == Vec3d{-1, -1, 1});
  CHECK(positions(b, 5121, "", R"(, "byteStride": 4)")[0] == Vec3d{128, 129, 127});
  CHECK(positions(raw<uint8_t>({255, 0, 51, 1, 2, 3, 4, 5, 6}), 5121, normalised)[0] == Vec3d{1, 0, 0.2});
  const std::string s =
      raw<int16_t>({-32768, 32767, 0}) + pads + raw<int16_t>({1, 2, 3}) + pads + raw<int16_t>({-1, -2, -3}) + pads;
  CHECK(positions(s, 5122, "", R"(, "byteStride": 8)")[2] == Vec3d{-1, -2, -3});
  CHECK(positions(s, 5122, normalised, R"(, "byteStride": 8)")[0] == Vec3d{-1, 1, 0});
  CHECK(positions(s, 5123, "", R"(, "byteStride": 8)")[2] == Vec3d{65535, 65534, 65533});
  // Not aligned, and in the middle of the view.
  const std::string f = std::string(1, 'x') + raw<float>({1, 2, 3, 4, 5, 6, 7, 8, 9});
  CHECK(positions(f, 5126, R"(, "byteOffset": 1)")[2] == Vec3d{7, 8, 9});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  CHECK(std::isnan(positions(raw<float>({1, nan, 3, 4, 5, 6, 7, 8, 9}), 5126, "")[0].y));

  const std::string sparse = raw<uint8_t>({0, 2}) + pads + raw<float>({9, 9, 9, 8, 8, 8});
  const std::string replaced_two =
      R"({"componentType": 5126, "count": 3, "type": "VEC3", "sparse": {"count": 2,
 "indices": {"bufferView": 0, "componentType": 5121}, "values": {"bufferView": 0, "byteOffset": 4}}})";
  const auto asset = read(primitive_gltf(sparse, replaced_two, R"({"attributes": {"POSITION": 0}})"));
  CHECK(sound(asset).meshes[0].mesh.positions == std::vector<Vec3d>{{9, 9, 9}, {0, 0, 0}, {8, 8, 8}});
  CHECK(mentions(fault(primitive_gltf(raw<uint8_t>({2, 0}) + sparse.substr(2), replaced_two,
                                      R"({"attributes": {"POSITION": 0}})")),
                 "do not ascend"));
}

TEST_CASE("gltf: materials") {
  const Asset asset = sound(
      read(replaced(replaced(square_gltf(R"(, "materials": [{"name": "a"}, {"name": "b", "pbrMetallicRoughness":
{"baseColorFactor": [0.5, 0.25, 2, 1], "metallicFactor": 0, "roughnessFactor": 0.5}}, {"pbrMetallicRoughness":
{"baseColorFactor": [1, 0.5, 0, 1], "metallicFactor": 1, "roughnessFactor": 0}}])"),
                             R"("primitives": [{)", R"("primitives": [{"attributes": {"POSITION": 0}, "material": 1},
{"attributes": {"POSITION": 0}, "material": 2}, {"attributes": {"POSITION": 0}}, {)"),
                    R"("indices": 2})", R"("indices": 2, "material": 1})")));
  const Mesh& mesh = asset.meshes[0].mesh;
  CHECK(mesh.material_names == std::vector<std::string>{"b", "material_2", "default"});
  CHECK(mesh.material_ids == std::vector<uint16_t>{0, 1, 2, 0, 0});
  CHECK(mesh.materials[0].diffuse == Vec3f{0.5f, 0.25f, 1});
  CHECK(mesh.materials[0].ambient == mesh.materials[0].diffuse);
  CHECK(mesh.materials[0].specular == Vec3f{0.02f, 0.02f, 0.02f});
  CHECK(mesh.materials[0].shininess == 30);
  CHECK(mesh.materials[1].specular == Vec3f{1, 0.5f, 0});
  CHECK(mesh.materials[1].shininess == 1000);
  CHECK(mesh.materials[2] == Material{});
  // Normals of some primitives only.
  CHECK(mesh.normal_indices[0] == std::array<uint32_t, 3>{kNoIndex, kNoIndex, kNoIndex});
  CHECK(mesh.normal_indices[3] == std::array<uint32_t, 3>{0, 1, 2});
}

TEST_CASE("gltf: emission is its factor times its strength, and left dark where a texture has it") {
  const auto emission = [](const std::string& members) {
    const std::string gltf = replaced(square_gltf(R"(, "materials": [{"name": "a", )" + members + "}]"),
                                      R"("indices": 2})", R"("indices": 2, "material": 0})");
    return sound(read(gltf)).meshes[0].mesh.materials[0].emission;
  };
  const std::string factor = R"("emissiveFactor": [1, 0.5, 0])";
  const auto strength = [](const std::string& value) {
    return R"(, "extensions": {"KHR_materials_emissive_strength": {)" + value + "}}";
  };
  CHECK(emission(factor) == Vec3f{1, 0.5f, 0});
  CHECK(emission(factor + strength(R"("emissiveStrength": 8)")) == Vec3f{8, 4, 0});
  CHECK(emission(factor + strength(R"("emissiveStrength": 0.5)")) == Vec3f{0.5f, 0.25f, 0});
  CHECK(emission(factor + strength(R"("emissiveStrength": -3)")) == Vec3f{0, 0, 0});
  CHECK(emission(factor + strength(R"("emissiveStrength": 1e300)")).x == std::numeric_limits<float>::max());
  CHECK(emission(factor + strength("")) == Vec3f{1, 0.5f, 0});
  CHECK(emission(R"("emissiveFactor": [-1, 7, 0.25])") == Vec3f{0, 1, 0.25f});
  CHECK(emission(factor + R"(, "emissiveTexture": {"index": 0})") == Vec3f{0, 0, 0});
}

TEST_CASE("gltf: nodes place meshes, through translations, rotations, scales and matrices") {
  const std::string nodes = R"("nodes": [
{"name": "parent", "translation": [10, 0, 0], "rotation": [0, 0, 0.70710678118654757, 0.70710678118654757], "children": [2, 1]},
{"name": "flat", "mesh": 0, "scale": [1, 0, 1]},
{"name": "child", "mesh": 0, "scale": [1, 2, -3]},
{"name": "sheared", "mesh": 0, "matrix": [1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1]},
{"name": "unused", "mesh": 0}], "scenes": [{"nodes": [4]}, {"nodes": [3, 0]}], "scene": 1)";
  const Asset asset = sound(read(replaced(square_gltf(), R"("nodes": [{"mesh": 0}])", nodes)));
  REQUIRE(asset.instances.size() == 2);
  CHECK(asset.instances[0].name == "sheared");
  CHECK(asset.instances[0].frame.apply_point({1, 2, 3}) == Vec3d{9, 10, 12});
  CHECK(asset.instances[1].name == "child");
  CHECK(length(asset.instances[1].frame.apply_point({1, 1, 1}) - Vec3d{8, 1, -3}) < 1e-12);
  REQUIRE(asset.warnings.size() == 1);
  CHECK(mentions(asset.warnings[0], "1 placement(s) left out"));
  CHECK_FALSE(asset.is_plain_mesh());
}

TEST_CASE("gltf: a camera and lights") {
  const std::string nodes = R"("nodes": [{"mesh": 0}, {"camera": 0}, {"translation": [0.5, 0.5, 4], "camera": 1},
{"camera": 1}, {"translation": [0.5, 0.5, 2], "extensions": {"KHR_lights_punctual": {"light": 0}}},
{"rotation": [0, 0.70710678118654757, 0, 0.70710678118654757], "extensions": {"KHR_lights_punctual": {"light": 1}}},
{"translation": [0.5, 0.5, -1], "extensions": {"KHR_lights_punctual": {"light": 2}}},
{"extensions": {"KHR_lights_punctual": {"light": 3}}}],
"cameras": [{"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 1}},
 {"type": "perspective", "perspective": {"yfov": 1.0471975511965976, "znear": 0.1}}],
"extensionsRequired": ["KHR_lights_punctual"],
"extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "color": [1, 0.5, 0], "intensity": 8},
 {"type": "directional"}, {"type": "spot", "spot": {}, "intensity": 4}, {"type": "point", "intensity": -1}]}})";
  const Asset asset = sound(read(replaced(square_gltf(), R"("nodes": [{"mesh": 0}])", nodes)));
  REQUIRE(asset.camera);
  CHECK(asset.camera->position == Vec3d{0.5, 0.5, 4});
  CHECK(length(asset.camera->target - Vec3d{0.5, 0.5, 0}) < 1e-12);
  CHECK(asset.camera->up == Vec3d{0, 1, 0});
  CHECK(asset.camera->vertical_fov_degrees == doctest::Approx(60));
  REQUIRE(asset.lights.size() == 3);
  // 8 / 2^2, 1 and 4 / 1^2, over the brightest component.
  CHECK(asset.lights[0].point);
  CHECK(asset.lights[0].position == Vec3d{0.5, 0.5, 2});
  CHECK(asset.lights[0].colour == Vec3f{0.5f, 0.25f, 0});
  CHECK_FALSE(asset.lights[1].point);
  CHECK(length(asset.lights[1].direction - Vec3d{-1, 0, 0}) < 1e-12);
  CHECK(asset.lights[1].colour == Vec3f{0.25f, 0.25f, 0.25f});
  CHECK(asset.lights[2].colour == Vec3f{1, 1, 1});
  REQUIRE(asset.warnings.size() == 3);
  CHECK(mentions(asset.warnings[0], "2 camera(s)"));
  CHECK(mentions(asset.warnings[1], "1 spot light(s)"));
  CHECK(mentions(asset.warnings[2], "1 light(s) left out"));
}

TEST_CASE("gltf: what is not read is said once a kind") {
  const std::string more =
      R"(, "textures": [{"source": 0}, {}], "images": [{"uri": "/nowhere.png"}, {"bufferView": 77}],
"samplers": [{}], "skins": [{"joints": [0]}], "animations": [{"channels": [], "samplers": []}],
"materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])";
  const Asset asset = sound(read(replaced(square_gltf(more), R"("indices": 2})",
                                          R"("indices": 2, "material": 0, "targets": [{"POSITION": 0}]})")));
  REQUIRE(asset.warnings.size() == 4);
  CHECK(mentions(asset.warnings[0], "textures"));
  CHECK(mentions(asset.warnings[1], "skins"));
  CHECK(mentions(asset.warnings[2], "animations"));
  CHECK(mentions(asset.warnings[3], "morph"));
}

TEST_CASE("gltf: numbers that point to nothing") {
  struct Row {
    const char *from, *to, *message;
  };
  const std::string square =
      square_gltf(R"(, "materials": [{}], "cameras": [], "scenes": [{"nodes": [0]}], "scene": 0)");
  for (const Row& row : {
           Row{R"("POSITION": 0)", R"("POSITION": 3)", "accessor 3 is used, but there are 3"},
           Row{R"("POSITION": 0)", R"("POSITION": -1)", "must be a whole number"},
           Row{R"("POSITION": 0)", R"("POSITION": 4294967296)", "must be a whole number"},
           Row{R"("POSITION": 0)", R"("POSITION": "0")", "must be a whole number"},
           Row{R"("POSITION": 0)", R"("POSITION": 2)", "accessor 2 is not of vectors"},
           Row{R"("POSITION": 0)", R"("a\nb": -1)", "must be a whole number"},
           Row{R"("version": "2.0")", R"("version": "3\n0")", "glTF version 3 0"},
           Row{R"("NORMAL": 1)", R"("NORMAL": 99)", "accessor 99"},
           Row{R"("indices": 2)", R"("indices": 99)", "out of bounds"},
           Row{R"("indices": 2)", R"("indices": 0)", "accessor 0 is not of scalars"},
           Row{R"("indices": 2)", R"("indices": 2, "material": 1)", "has material 1, but there are 1"},
           Row{R"([{"mesh": 0}])", R"([{"mesh": 1}])", "has mesh 1, but there are 1"},
           Row{R"([{"mesh": 0}])", R"([{"mesh": 18446744073709551616}])", "'/nodes/0/mesh' must be a whole number"},
           Row{R"([{"mesh": 0}])", R"([{"camera": 0}])", "has camera 0, but there are 0"},
           Row{R"([{"mesh": 0}])", R"([{"children": [1]}])", "has the child 1"},
           Row{R"([{"mesh": 0}])", R"([{"children": [0]}])", "form a cycle"},
           Row{R"([{"mesh": 0}])", R"([{"children": [1, 1]}, {}])", "two parents"},
           Row{R"([{"mesh": 0}])", R"([{"children": [2]}, {"children": [2]}, {}])", "two parents"},
           Row{R"([{"mesh": 0}])", R"([{}, {"children": [2]}, {"children": [1]}])", "form a cycle"},
           Row{R"([{"mesh": 0}])", R"([{"extensions": {"KHR_lights_punctual": {"light": 0}}}])", "has light 0"},
           Row{R"([{"mesh": 0}])", R"([{"extensions": {"KHR_lights_punctual": {"light": -1}}}])", "whole number"},
           Row{R"([{"mesh": 0}])", R"([{"matrix": [1, 2]}])", "'/nodes/0/matrix' must be an array of 16 numbers"},
           Row{R"([{"mesh": 0}])", R"([{"matrix": [1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1]}])", "last row"},
           Row{R"([{"mesh": 0}])", R"([{"rotation": [0, 0, 0, 0]}])", "quaternion"},
           Row{R"([{"mesh": 0}])", R"([{"translation": [1, "2", 3]}])", "'/nodes/0/translation/1' must be a number"},
           Row{R"("nodes": [0])", R"("nodes": [1])", "has node 1, but there are 1"},
           Row{R"("nodes": [0])", R"("nodes": [0, 0])", "twice"},
           Row{R"("scene": 0)", R"("scene": 1)", "the default scene is 1, but there are 1"},
           Row{R"("buffer": 0, "byteLength": 48)", R"("buffer": 1, "byteLength": 48)",
               "uses buffer 1, but there are 1"},
           Row{R"("buffer": 0, "byteLength": 48)", R"("buffer": 0, "byteLength": 109)", "ends behind its buffer's 108"},
           Row{R"("byteOffset": 48)", R"("byteOffset": 61)", "ends behind its buffer's 108"},
           Row{R"("byteOffset": 48)", R"("byteOffset": 9007199254740992)", "ends behind its buffer's 108"},
           Row{R"("byteOffset": 48)", R"("byteOffset": 18446744073709551615)", "whole number"},
           Row{R"("byteOffset": 48)", R"("byteOffset": -48)", "whole number"},
           Row{R"("buffer": 0, "byteLength": 48)", R"("buffer": 0, "byteLength": 48, "byteStride": 8)", "8 apart"},
           Row{R"("buffer": 0, "byteLength": 48)", R"("buffer": 0, "byteLength": 48, "byteStride": 16)", "end behind"},
           Row{R"("count": 4)", R"("count": 5)", "has 5 elements of 12 bytes, which end behind"},
           Row{R"("count": 4)", R"("count": 4000000000000)", "which end behind"},
           Row{R"("bufferView": 0, )", R"("bufferView": 3, )", "uses buffer view 3, but there are 3"},
           Row{R"("bufferView": 0, )", R"("byteOffset": 40, "bufferView": 0, )", "end behind"},
           Row{R"("bufferView": 0, )", R"("byteOffset": 4000000000, "bufferView": 0, )", "end behind"},
           Row{R"("bufferView": 0, "componentType": 5126, "count": 4)", R"("componentType": 5126, "count": 4000000000)",
               "normals"},
           Row{R"("componentType": 5126)", R"("componentType": 5124)", "none of glTF's"},
           Row{R"("componentType": 5126)", R"("componentType": 5125)", "32-bit integers"},
           Row{R"("componentType": 5126)", R"("componentType": 7)", "componentType"},
           Row{R"("componentType": 5123)", R"("componentType": 5122)", "no unsigned integers"},
           Row{R"("count": 4, "type": "VEC3"})", R"("count": 3, "type": "VEC3"})", "3 positions, but 4 normals"},
           Row{R"("byteLength": 108)", R"("byteLength": 109)", "has 108 of its 109 bytes"},
           Row{R"("byteLength": 108)", R"("byteLength": 4000000000000)", "truncated"},
           Row{R"("byteLength": 108, )", "", "no 'byteLength'"},
           Row{"base64,", "base64,!", "not in base64"},
           Row{R"("version": "2.0")", R"("version": "1.0")", "glTF version 1.0"},
           Row{R"("asset")", R"("assets")", "no glTF 2.0 file"},
           Row{R"("asset")", R"("extensionsRequired": ["KHR_draco_mesh_compression"], "asset")",
               "the required extension 'KHR_draco_mesh_compression'"},
           Row{R"("asset")", R"("extensionsRequired": ["EXT_meshopt_compression"], "asset")",
               "EXT_meshopt_compression"},
           Row{R"("attributes")", R"("attribute")", "attributes"},
           Row{R"("materials": [{}])", R"("materials": [3])", "'/materials/0' must be an object"},
           Row{R"("POSITION": 0)", R"("a/b~c": "x")", "'/meshes/0/primitives/0/attributes/a~1b~0c' must be"},
           Row{R"({"version": "2.0"})", R"({"version": "1.0"}, "nodes": {"a": {}})", "glTF version 1.0"},
           Row{R"("cameras": [])", R"("cameras": [{"type": "perspective"}])", "tinygltf"},
       }) {
    CAPTURE(std::string(row.to));
    const std::string line = fault(replaced(square, row.from, row.to));
    CHECK_MESSAGE(mentions(line, row.message), line);
  }
}

TEST_CASE("gltf: an index without its vertex") {
  const std::string bytes = square_bytes().substr(0, 106) + raw<uint16_t>({4});
  CHECK(mentions(fault(glb(square_json(""), bytes), "a.glb"), "uses vertex 4 (from 0), but has 4"));
  CHECK(mentions(fault(glb(square_json(""), square_bytes().substr(0, 106) + raw<uint16_t>({65535})), "a.glb"),
                 "uses vertex 65535"));
}

TEST_CASE("gltf: a small file allocates and reads no more than it may") {
  const auto start = std::chrono::steady_clock::now();
  const std::string zeros = R"({"componentType": 5126, "count": 4000000000, "type": "VEC3"})";
  CHECK(mentions(fault(primitive_gltf("1234", zeros, R"({"attributes": {"POSITION": 0}})")), "share too much"));
  // Each primitive alone would do.
  const std::string strip =
      R"({"componentType": 5126, "count": 1000000, "type": "VEC3"}, {"bufferView": 0, "componentType": 5121, "count": 3, "type": "SCALAR"})";
  std::string primitives = R"({"attributes": {"POSITION": 0}, "indices": 1})", accessors = strip;
  for (int i = 2; i < 100; ++i) {
    primitives += fmt::format(R"(, {{"attributes": {{"POSITION": {}}}, "indices": 1}})", i);
    accessors += R"(, {"componentType": 5126, "count": 1000000, "type": "VEC3"})";
  }
  CHECK(mentions(fault(primitive_gltf(std::string("\0\1\2", 3), accessors, primitives)), "share too much"));
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(20));
}

TEST_CASE("gltf: a million vertices that many primitives share are not read anew for each") {
  std::string bytes(12000000, '\0');
  bytes.replace(0, 36, raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}));
  bytes += raw<uint8_t>({0, 1, 2});
  std::string primitives = R"({"attributes": {"POSITION": 0}, "indices": 1})";
  for (int i = 0; i < 20000; ++i) primitives += R"(, {"attributes": {"POSITION": 0}, "indices": 1})";
  const std::string json = fmt::format(
      R"({{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": {}}}],
"bufferViews": [{{"buffer": 0, "byteLength": {}}}], "accessors": [
 {{"bufferView": 0, "componentType": 5126, "count": 1000000, "type": "VEC3"}},
 {{"bufferView": 0, "byteOffset": 12000000, "componentType": 5121, "count": 3, "type": "SCALAR"}}],
"meshes": [{{"primitives": [{}]}}]}})",
      bytes.size(), bytes.size(), primitives);
  const Asset asset = sound(read(glb(json, bytes), "a.glb"));
  CHECK(asset.meshes[0].mesh.triangles.size() == 20001);
  CHECK(asset.meshes[0].mesh.positions.size() == 3 * 20001);
}

TEST_CASE("gltf: containers that are cut, padded or lie") {
  const std::string whole = glb(square_json(""), square_bytes());
  for (size_t size = 0; size < whole.size(); ++size) fault(whole.substr(0, size), "a.glb");
  CHECK(read(whole + "behind", "a.glb"));
  const auto with_word = [&](size_t at, uint32_t word) {
    std::string bytes = whole;
    return bytes.replace(at, 4, raw<uint32_t>({word}));
  };
  CHECK(mentions(fault(with_word(4, 1), "a.glb"), "GLB version 1"));
  CHECK(mentions(fault(with_word(8, static_cast<uint32_t>(whole.size() + 1)), "a.glb"), "truncated"));
  CHECK(mentions(fault(with_word(12, 0xffffffff), "a.glb"), "chunk 0 ends behind"));
  CHECK(mentions(fault(with_word(16, 7), "a.glb"), "not JSON"));
  // A chunk's length that is no multiple of four: with padding behind it, as the file's length tells, or without.
  std::string json = square_json("");
  json.resize((json.size() + 3) / 4 * 4 + 2, ' ');
  const auto with_odd_json = [&](const std::string& padding) {
    const std::string even = glb(json, square_bytes());
    return raw<uint32_t>({0x46546c67, 2, static_cast<uint32_t>(28 + json.size() + padding.size() + 108),
                          static_cast<uint32_t>(json.size()), 0x4e4f534a}) +
           json + padding + even.substr(even.size() - 116);
  };
  CHECK(sound(read(with_odd_json(""), "a.glb")).is_plain_mesh());
  CHECK(sound(read(with_odd_json("  "), "a.glb")).is_plain_mesh());
  const size_t second = whole.size() - 108 - 8;
  CHECK(mentions(fault(with_word(second, 109), "a.glb"), "chunk 1 ends behind"));
  CHECK(mentions(fault(with_word(second + 4, 7), "a.glb"), "no binary chunk"));
  CHECK(mentions(fault(with_word(8, static_cast<uint32_t>(second)), "a.glb"), "no binary chunk"));
}

TEST_CASE("gltf: JSON that is none, or nested without end") {
  for (const std::string text : {"", "{", "[]", "3", "nonsense", "{\"asset\": {\"version\": \"2.0\"}} x",
                                 "{\"a\": 1e999}", "{\"a\": \"\xff\"}"}) {
    CAPTURE(text);
    fault(text);
  }
  CHECK(mentions(fault(R"({"asset": {"version": "2.0"}})"), "no faces"));
  const std::string open(100000, '['), close(100000, ']');
  CHECK(mentions(fault(square_gltf(R"(, "extras": )" + open + close)), "nested more than 64"));
  CHECK(mentions(fault(square_gltf(R"(, "extensions": {"EXT_x": )" + open + close + "}")), "nested more than 64"));
  fault(std::string(1000000, '['));
  std::string objects;
  for (int i = 0; i < 100000; ++i) objects += "{\"a\":";
  fault(objects);
}

TEST_CASE("gltf: a chain of nodes as long as the file allows") {
  std::string nodes = R"("nodes": [{"mesh": 0, "translation": [1, 0, 0]})";
  const int count = 100000;
  for (int i = 0; i < count; ++i) nodes += fmt::format(R"(, {{"translation": [1, 0, 0], "children": [{}]}})", i);
  const Asset asset = sound(read(replaced(square_gltf(), R"("nodes": [{"mesh": 0}])", nodes + "]")));
  CHECK(asset.instances.at(0).frame.point == Vec3d{count + 1, 0, 0});
}
