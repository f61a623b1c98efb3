// Assets: one mesh or several, split by what the file says, and their names.
#include <doctest/doctest.h>
#include "gltf_texts.h"
#include "mesh/asset.h"
#include "mesh/clean.h"
#include "mesh/file_names.h"
#include "support/temp_folder.h"

using namespace kd;
using namespace kd::mesh;
using namespace kd::test;

namespace {

Asset read(const std::string& name, const std::string& contents, Split split, const std::string& mtl = "") {
  const TempFolder folder;
  if (!mtl.empty()) folder.write("m.mtl", mtl);
  const auto asset = read_asset(folder.write(name, contents), {}, split);
  REQUIRE_MESSAGE(asset, (asset ? "" : asset.error().line()));
  return *asset;
}

std::vector<std::string> names_of(const Asset& asset) {
  std::vector<std::string> names;
  for (const NamedMesh& mesh : asset.meshes) names.push_back(mesh.name);
  return names;
}

const std::string kCorners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvn 0 1 0\n";
const std::string kMtl = "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\nnewmtl none\nKd 0 1 0\n";

}  // namespace

TEST_CASE("asset: a mesh alone stands where it was made, named after its file") {
  const std::string off = "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const Asset asset = read("two words.v2.off", off, Split::none);
  CHECK(asset.is_plain_mesh());
  CHECK(asset.meshes.at(0).name == "two_words.v2");
  CHECK(asset.warnings.empty());
  for (const Split split : {Split::object, Split::material}) {
    const Asset whole = read("a.off", off, split);
    CHECK(whole.is_plain_mesh());
    REQUIRE(whole.warnings.size() == 1);
    CHECK(whole.warnings[0].starts_with("not split"));
  }
  const TempFolder folder;
  CHECK(read_asset(folder.file("none.obj"), {}, Split::none).error().error_class == ErrorClass::missing);
  CHECK(read_asset(folder.write("a.fbx", ""), {}, Split::none).error().what.find(".glb") != std::string::npos);
  CHECK_FALSE(read_mesh(folder.write("a.gltf", square_gltf()), {}));
}

TEST_CASE("asset: OBJ groups") {
  const std::string obj = "mtllib m.mtl\n" + kCorners +
                          "f 1 2 3\no empty\no Wall\nusemtl red\nf 1//1 2//1 3//2\ng a b\nf 1 3 4\ng wall\nf 2 3 "
                          "4\ng\nf 1 2 4\ng Wall\nf 1 2 3 4\n";
  const Asset asset = read("a.obj", obj, Split::object, kMtl);
  CHECK(names_of(asset) == std::vector<std::string>{"default", "Wall", "a_b", "wall_2"});
  REQUIRE(asset.instances.size() == 4);
  CHECK(asset.instances[1].mesh == 1);
  CHECK(asset.instances[1].name == "Wall");
  CHECK(asset.instances[1].frame.apply_point({1, 2, 3}) == Vec3d{1, 2, 3});
  CHECK_FALSE(asset.is_plain_mesh());
  const Mesh& wall = asset.meshes[1].mesh;
  CHECK(wall.source_primitives == std::vector<uint32_t>{1, 5, 6});
  CHECK(wall.positions.size() == 4);
  CHECK(wall.normals == std::vector<Vec3f>{{0, 0, 1}, {0, 1, 0}});
  CHECK(wall.normal_indices[0] == std::array<uint32_t, 3>{0, 0, 1});
  CHECK(wall.normal_indices[1] == std::array<uint32_t, 3>{kNoIndex, kNoIndex, kNoIndex});
  CHECK(wall.material_names == std::vector<std::string>{"red"});
  const Mesh& first = asset.meshes[0].mesh;
  CHECK(first.source_primitives == std::vector<uint32_t>{0, 4});
  CHECK(first.normals.empty());
  CHECK(first.normal_indices.empty());
  CHECK(first.material_names == std::vector<std::string>{"default", "red"});
  CHECK(first.material_ids == std::vector<uint16_t>{0, 1});
  CHECK(asset.meshes[2].mesh.positions == std::vector<Vec3d>{{0, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  for (const NamedMesh& mesh : asset.meshes) CHECK(mesh.whole == 0);

  const Asset whole = read("a.obj", obj, Split::none, kMtl);
  CHECK(names_of(whole) == std::vector<std::string>{"a"});
  CHECK(whole.meshes[0].mesh.group_ids == std::vector<uint32_t>{0, 2, 3, 4, 0, 2, 2});
  Mesh cleaned = whole.meshes[0].mesh;
  clean(cleaned);
  CHECK(cleaned.group_ids.size() == cleaned.triangles.size());
}

TEST_CASE("asset: materials, of a mesh and of several") {
  const std::string obj =
      "mtllib m.mtl\nusemtl blue\n" + kCorners + "f 1 2 3\nusemtl red\nf 1 3 4\nusemtl blue\nf 2 3 4\n";
  const Asset asset = read("a.obj", obj, Split::material, kMtl);
  CHECK(names_of(asset) == std::vector<std::string>{"red", "blue"});
  CHECK(asset.meshes[1].mesh.source_primitives == std::vector<uint32_t>{0, 2});
  CHECK(asset.meshes[1].mesh.materials.at(0).diffuse == Vec3f{0, 0, 1});
  CHECK(asset.meshes[1].mesh.material_ids == std::vector<uint16_t>{0, 0});

  std::string gltf = square_gltf(R"(, "materials": [{"name": "red"}, {"name": "blue"}])");
  const std::string primitive = R"({"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2})",
                    mesh = R"({"name": "square", "primitives": [)" + primitive + "]}";
  gltf.replace(gltf.find(mesh), mesh.size(),
               R"({"name": "Two", "primitives": [{"attributes": {"POSITION": 0}, "indices": 2, "material": 1},
{"attributes": {"POSITION": 0}, "indices": 2, "material": 0}]}, {"name": "two", "primitives": [)" +
                   primitive + "]}");
  const std::string nodes = R"([{"mesh": 0}])";
  gltf.replace(gltf.find(nodes), nodes.size(),
               R"([{"name": "n", "mesh": 0}, {"mesh": 1}, {"mesh": 0, "translation": [1, 0, 0]}])");
  const Asset split = read("a.gltf", gltf, Split::material);
  CHECK(names_of(split) == std::vector<std::string>{"Two_blue", "Two_red", "two_2"});
  std::vector<uint32_t> placed;
  for (const MeshInstance& instance : split.instances) placed.push_back(instance.mesh);
  CHECK(placed == std::vector<uint32_t>{0, 1, 2, 0, 1});
  CHECK(split.instances[1].name == "n");
  CHECK(split.instances[4].frame.point == Vec3d{1, 0, 0});
  CHECK(split.meshes[1].whole == 0);
  CHECK(split.meshes[2].whole == 1);
  CHECK(names_of(read("a.gltf", gltf, Split::object)) == std::vector<std::string>{"Two", "two_2"});
}

TEST_CASE("asset: splitting takes no time in the number of parts") {
  std::string obj;
  const int count = 100000;
  for (int i = 0; i < count; ++i) obj += fmt::format("v {} 0 0\nv {} 1 0\nv {} 0 1\n", i, i, i);
  for (int i = 0; i < count; ++i) obj += fmt::format("g {}\nf {} {} {}\n", i, 3 * i + 1, 3 * i + 2, 3 * i + 3);
  const Asset asset = read("a.obj", obj, Split::object);
  REQUIRE(asset.meshes.size() == count);
  CHECK(asset.meshes.back().mesh.positions.at(0) == Vec3d{count - 1, 0, 0});
  CHECK(asset.meshes.back().mesh.positions.size() == 3);
}

TEST_CASE("asset: names that are fit for files, once each") {
  FileNames names;
  CHECK(names.give("Wall") == "Wall");
  CHECK(names.give("wall") == "wall_2");
  CHECK(names.give("WALL") == "WALL_3");
  CHECK(names.give("wall_2") == "wall_2_2");
  CHECK(names.give("../etc/passwd") == "_._etc_passwd");
  CHECK(names.give("-rf") == "_rf");
  CHECK(names.give("") == "mesh");
  CHECK(names.give(std::string("a\0b\nc", 5)) == "a_b_c");
  CHECK(names.give("Altär 東") == "Alt_r__");
  CHECK(names.give(std::string(1000, 'x')).size() == 80);
  CHECK(names.give(std::string(1000, 'x')).size() == 82);
  FileNames many;
  for (int i = 0; i < 50000; ++i) many.give("same");
  CHECK(many.give("same") == "same_50001");
}
