// The scenes that kdbuild writes: over none that is somebody's own work, and in time that the source's size tells.
#include <chrono>

#include <doctest/doctest.h>

#include "cli/meshes.h"
#include "cli/run_tool.h"
#include "kdbuild/asset_scene.h"

using namespace kd;
using namespace kd::test;

namespace {

constexpr const char* kTool = "kdbuild";

const std::string kTwoMaterials =
    "v 0 0 0\nv 3 0 0\nv 3 2 0\nv 0 2 1\nmtllib m.mtl\nusemtl red\nf 1 2 3\nusemtl green\nf 1 3 4\n";
const std::string kMtl = "newmtl red\nKd 1 0 0\nnewmtl green\nKd 0 1 0\n";
const std::string kOneInstance = R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0, "scale": [2, 2, 2]}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
"accessors": [{"bufferView": 0, "componentType": 5121, "count": 3, "type": "VEC3"}],
"bufferViews": [{"buffer": 0, "byteLength": 9}],
"buffers": [{"byteLength": 9, "uri": "data:application/octet-stream;base64,AAAAAQAAAAEA"}]})";

}  // namespace

TEST_SUITE("kdbuild build, scenes") {
  TEST_CASE("a scene written by hand is not replaced, unless --force says so") {
    const Terminal t;
    t.write("m.mtl", kMtl);
    t.write("two.obj", kTwoMaterials);
    t.write("one.gltf", kOneInstance);
    t.write("grid.ply", grid_ply(60));
    for (const Arguments& build : {Arguments{"build", "two.obj", "-o", "x.nkd", "--split", "material"},
                                   Arguments{"build", "one.gltf", "-o", "x.nkd"},
                                   Arguments{"build", "grid.ply", "-o", "x.nkd", "--max-object-size", "120000"}}) {
      for (const char* own :
           {"{\"my\": \"settings\"}\n", "", "{\n  \"generator\": \"kdtrace, XXH3 0123456789abcdef\",\n}"}) {
        t.write("x.json", own);
        t.fails(kTool, build, ErrorClass::output, {"x.json", "--force"});
      }
      Arguments forced = build;
      forced.push_back("--force");
      t.succeeds(kTool, forced);
      CHECK(nlohmann::json::parse(t.read("x.json")).contains("objects"));
    }
    t.write("x.json", "mine");
    t.succeeds(kTool, {"build", "grid.ply", "-o", "x.nkd"});
    CHECK(t.read("x.json") == "mine");
  }

  TEST_CASE("one that kdbuild wrote is replaced until it is edited") {
    const Terminal t;
    t.write("m.mtl", kMtl);
    t.write("two.obj", kTwoMaterials);
    const Arguments build{"build", "two.obj", "-o", "x.nkd", "--split", "material"};
    t.succeeds(kTool, build);
    const std::string scene = t.read("x.json");
    t.write("two.obj", "# changed\n" + kTwoMaterials);
    t.succeeds(kTool, build);
    CHECK(t.read("x.json") == scene);

    std::string edited = scene;
    edited.replace(edited.find("512"), 3, "640");
    t.write("x.json", edited);
    CHECK(t.succeeds(kTool, build).out == "two.obj -> x.json: up to date\n");
    CHECK(t.run("kdrender", {"x.json", "-o", "x.exr", "--device", "cpu", "--quiet"}).status == 0);
    t.write("two.obj", kTwoMaterials);
    t.fails(kTool, build, ErrorClass::output, {"x.json", "edited"});
    t.succeeds(kTool, {"build", "two.obj", "-o", "x.nkd", "--split", "material", "--force"});
    CHECK(t.read("x.json") == scene);
  }

  TEST_CASE("instances of many meshes are placed in time that their number tells") {
    constexpr uint32_t kMeshes = 100'000;  // every instance with every mesh would be 10^10 looks
    mesh::Asset asset;
    std::vector<tools::SceneMember> members;
    asset.meshes.resize(kMeshes);
    for (uint32_t i = 0; i < kMeshes; ++i) {
      asset.instances.push_back({"", kMeshes - 1 - i, {}});
      if (i % 2) members.push_back({std::to_string(i), std::to_string(i) + ".nkd", i, {{0, 0, 0}, {1, 1, 1}}});
      if (i == 7) members.push_back({"more of 7", "7.1.nkd", 7, {{0, 0, 0}, {1, 1, 1}}});
    }
    const auto start = std::chrono::steady_clock::now();
    const scene::Scene scene = tools::asset_scene(asset, "many", members);
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(2));
    const auto& parts = scene.characters.at(0).parts;
    REQUIRE(parts.size() == kMeshes / 2 + 1);
    CHECK(members[parts.front().object].mesh == kMeshes - 1);
    CHECK(members[parts.back().object].mesh == 1);
    size_t of_seven = 0;
    for (const scene::Part& part : parts) of_seven += members[part.object].mesh == 7;
    CHECK(of_seven == 2);
  }
}
