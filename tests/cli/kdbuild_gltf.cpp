// kdbuild on glTF, from outside: meshes to objects, and the scene that the file describes.
#include <doctest/doctest.h>

#include "cli/json_schema.h"
#include "cli/run_tool.h"

using namespace kd;
using namespace kd::test;

namespace {

/// Two instances of a tetrahedron, one mirrored and stretched, a camera and a light. The buffer lies beside it.
const std::string kTwoTetrahedra = R"({
  "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2, 3]}],
  "nodes": [{"mesh": 0, "name": "a"},
            {"mesh": 0, "name": "b", "translation": [2, 0, 0], "scale": [-1, 2, 1]},
            {"camera": 0, "translation": [0.5, 0.5, 6]},
            {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [1, 3, 4]}],
  "meshes": [{"name": "tet", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
  "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}],
  "extensionsUsed": ["KHR_lights_punctual"],
  "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "color": [1, 0.5, 0.25], "intensity": 50}]}},
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
                {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
  "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
  "buffers": [{"byteLength": 72, "uri": "tet.bin"}]
})";

std::string tetrahedron_bin(float size) {
  const float positions[12] = {0, 0, 0, size, 0, 0, 0, size, 0, 0, 0, size};
  const uint16_t corners[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  std::string bytes(reinterpret_cast<const char*>(positions), sizeof positions);
  return bytes.append(reinterpret_cast<const char*>(corners), sizeof corners);
}

}  // namespace

TEST_SUITE("kdbuild build, glTF") {
  TEST_CASE("meshes become objects, nodes instances, and the scene renders") {
    const Terminal t;
    t.write("two.gltf", kTwoTetrahedra);
    t.write("tet.bin", tetrahedron_bin(1));
    const Arguments build{"build", "two.gltf", "-o", "out/"};
    t.succeeds("kdbuild", build);
    t.succeeds("kdbuild", {"validate", "out/two.tet.nkd"});
    const auto scene = nlohmann::json::parse(t.read("out/two.json"));
    REQUIRE(scene["objects"].size() == 1);
    const auto& parts = scene["characters"][0]["parts"];
    REQUIRE(parts.size() == 2);
    CHECK(parts[1]["frame"]["x_axis"] == nlohmann::json{-1, 0, 0});
    CHECK(parts[1]["frame"]["y_axis"] == nlohmann::json{0, 2, 0});
    CHECK(parts[1]["frame"]["point"] == nlohmann::json{2, 0, 0});
    CHECK(scene["camera"]["position"] == nlohmann::json{0.5, 0.5, 6});
    CHECK(scene["camera"]["vertical_fov"].get<double>() == doctest::Approx(0.7 * 180 / 3.14159265358979));
    CHECK(scene["lights"][0]["colour"] == nlohmann::json{1, 0.5, 0.25});
    const auto stats =
        t.report("kdrender", {"out/two.json", "-o", "two.exr", "--device", "cpu", "--quiet", "--stats", "-"});
    CHECK(stats["rays"]["primary_hits"] > 10000);
  }

  TEST_CASE("a buffer beside it is part of what it is made from") {
    const Terminal t;
    t.write("two.gltf", kTwoTetrahedra);
    t.fails("kdbuild", {"build", "two.gltf", "-o", "two.nkd"}, ErrorClass::missing, {"tet.bin"});
    t.write("tet.bin", tetrahedron_bin(1));
    const Arguments build{"build", "two.gltf", "-o", "out/", "--depfile", "two.d"};
    t.succeeds("kdbuild", build);
    CHECK(t.read("two.d").find("tet.bin") != std::string::npos);
    CHECK(t.succeeds("kdbuild", build).out == "two.gltf -> out/two.json: up to date\n");
    const std::string before = t.read("out/two.tet.nkd");
    t.write("tet.bin", tetrahedron_bin(3));
    t.succeeds("kdbuild", build);
    CHECK(t.read("out/two.tet.nkd") != before);
  }

  TEST_CASE("no scene or part is written over what the run writes elsewhere") {
    const Terminal t;
    t.write("tet.bin", tetrahedron_bin(1));
    t.write("two.gltf", kTwoTetrahedra);
    t.fails("kdbuild", {"build", "two.gltf", "-o", ".", "--stats", "two.json"}, ErrorClass::usage, {"two.json"});
    t.fails("kdbuild", {"build", "two.gltf", "-o", ".", "--depfile", "two.json"}, ErrorClass::usage, {"two.json"});
    // Of these two, each would have the object x.a.b.nkd.
    const auto with_mesh = [](const std::string& name) {
      std::string gltf = kTwoTetrahedra;
      return gltf.replace(gltf.find("\"tet\""), 5, '"' + name + '"');
    };
    t.write("x.gltf", with_mesh("a.b"));
    t.write("x.a.gltf", with_mesh("b"));
    const ToolRun run = t.run("kdbuild", {"build", "x.gltf", "x.a.gltf", "-o", "out/", "--quiet"});
    CHECK(run.status == static_cast<int>(ErrorClass::usage));
    CHECK_MESSAGE(run.err.find("x.a.b.nkd") != std::string::npos, run.err);
    CHECK(t.exists("out/x.json"));
    CHECK(!t.exists("out/x.a.json"));
  }

  TEST_CASE("an object whose attributes are corrupt is not up to date") {
    const Terminal t;
    t.write("n.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n");
    t.succeeds("kdbuild", {"build", "n.obj", "-o", "n.nkd"});
    const std::string whole = t.read("n.nkd");
    const float normal[3] = {0, 0, 1};
    std::string spoilt = whole;
    const size_t at = spoilt.find(std::string(reinterpret_cast<const char*>(normal), sizeof normal));
    REQUIRE(at != std::string::npos);
    spoilt[at] ^= 1;
    t.write("n.nkd", spoilt);
    t.succeeds("kdbuild", {"build", "n.obj", "-o", "n.nkd"});
    CHECK(t.read("n.nkd") == whole);
  }
}
