// Which further files a mesh file names.
#include <doctest/doctest.h>

#include <chrono>

#include "gltf_texts.h"
#include "mesh/dependencies.h"

using namespace kd::mesh;
using Files = std::vector<std::string>;

namespace {

Files files_of(const std::string& text, const std::string& path) {
  const auto files = dependencies(std::as_bytes(std::span(text)), path);
  REQUIRE(files);
  return *files;
}

}  // namespace

TEST_CASE("dependencies: an OBJ's mtllib lines, as tinyobjloader parts them") {
  CHECK(files_of("", "a.obj") == Files{});
  CHECK(files_of("mtllib", "a.obj") == Files{});
  CHECK(files_of("v 0 0 0\nmtllib m.mtl", "a.obj") == Files{"m.mtl"});
  CHECK(files_of("mtllib a.mtl  b.mtl \rmtllib\ta.mtl\r\n", "in/a.OBJ") == Files{"in/a.mtl", "in/b.mtl"});
  CHECK(files_of("mtllib /abs/my\\ own.mtl\n", "in/a.obj") == Files{"/abs/my own.mtl"});
  CHECK(files_of("mtllib a.mtl \\\r\nb.mtl\nmtllib c.mtl\\", "a.obj") == Files{"a.mtl", "b.mtl", "c.mtl"});
  CHECK(files_of("# mtllib a.mtl\nmtllibs b.mtl\nusemtl mtllib\n", "a.obj") == Files{});
}

TEST_CASE("dependencies: a glTF's buffers outside it") {
  const std::string json =
      R"({"buffers": [{"uri": "a%20b.bin"}, {"uri": "data:;base64,AA=="}, {}, {"uri": "c.bin"}, {"uri": "c.bin"}],
          "images": [{"uri": "t.png"}]})";
  CHECK(files_of(json, "in/x.gltf") == Files{"in/a b.bin", "in/c.bin"});
  CHECK(files_of(kd::test::glb(json, "BIN"), "x.glb") == Files{"a b.bin", "c.bin"});
  for (const char* broken : {"", "{", "[]", "glTF", R"({"buffers": 1})", R"({"buffers": [1, {"uri": 2}]})"}) {
    CHECK(files_of(broken, "x.gltf") == Files{});
  }
}

TEST_CASE("dependencies: nesting without end is refused before it is parsed") {
  const auto start = std::chrono::steady_clock::now();
  CHECK(files_of(std::string(20'000'000, '['), "x.gltf") == Files{});
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
}

TEST_CASE("dependencies: other formats have none") { CHECK(files_of("mtllib m.mtl\n", "a.ply") == Files{}); }
