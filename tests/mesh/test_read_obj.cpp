// OBJ and MTL files, sound and broken.
#include <doctest/doctest.h>

#include <cmath>

#include <fmt/format.h>

#include "mesh/read_mesh.h"
#include "support/temp_folder.h"

using namespace kd;
using namespace kd::mesh;

namespace {

Result<Mesh> read(const std::string& obj, const std::string& mtl = "", const ReadOptions& options = {}) {
  const test::TempFolder folder;
  if (!mtl.empty()) folder.write("m.mtl", mtl);
  return read_mesh(folder.write("a.obj", obj), options);
}

Error error_of(const Result<Mesh>& result) {
  REQUIRE_FALSE(result);
  return result.error();
}

bool mentions(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const std::string kCorners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

double area_xy(const Mesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3d a = mesh.positions[t[0]];
    sum += cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a).z / 2;
  }
  return sum;
}

}  // namespace

TEST_CASE("obj: coordinates are the nearest doubles of what the file says") {
  const auto mesh = read("v 0.1 -2.5e-7 +1234567.891\nv nan inf 1e400\nv 1 2 3 1.0\nf 1 2 3\n");
  REQUIRE(mesh);
  CHECK(mesh->positions[0] == Vec3d{0.1, -2.5e-7, 1234567.891});
  CHECK(std::isnan(mesh->positions[1].x));
  CHECK(std::isinf(mesh->positions[1].y));
  CHECK(std::isinf(mesh->positions[1].z));
  CHECK(mesh->materials.empty());
  CHECK(mesh->material_ids.empty());
  CHECK(mesh->normals.empty());
  CHECK(mesh->warnings.empty());
}

TEST_CASE("obj: line ends, a missing one at the end, and relative indices") {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const auto mesh = read("v 0 0 0" + end + "v 1 0 0" + end + "v 1 1 0" + end + "f -3 -2 -1" + end + end + "v 0 0 1" +
                           end + "f 1 -2 -1");
    REQUIRE(mesh);
    REQUIRE(mesh->triangles.size() == 2);
    CHECK(mesh->triangles[0] == std::array<uint32_t, 3>{0, 1, 2});
    CHECK(mesh->triangles[1] == std::array<uint32_t, 3>{0, 2, 3});
  }
}

TEST_CASE("obj: comments and lines that go on") {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const std::string corners =
        "v 0 0 0 # one" + end + "# v 9 9 9" + end + "v 1 0 \\" + end + "0" + end + "v 1 1 0#" + end + "v 0 1 0" + end;
    for (const std::string& faces :
         std::vector<std::string>{"f 1 2 3 4", "f 1 2 3 4 # f 1 2", "f 1 2 3 4# \\", "f 1 2 \\" + end + "3 4",
                                  "f 1 2 \\" + end + "  # between \\" + end + "3 \\" + end + "4",
                                  "f \\" + end + "1\\" + end + "2\\" + end + "3\\" + end + "4 # end"}) {
      CAPTURE(faces);
      const auto mesh = read("# path C:\\" + end + corners + end + "  #" + end + faces);
      REQUIRE(mesh);
      CHECK(mesh->positions.size() == 4);
      CHECK(mesh->triangles == std::vector<std::array<uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}});
      CHECK(mesh->warnings.empty());
    }
  }
  // A place is the line on which the statement begins, whatever went before.
  const Error error = error_of(read(kCorners + "f 1 2 \\\n3\n\nf 1 \\\n2 \\\n7\nf 1 2 3\n"));
  CHECK(mentions(error.where, "a.obj:8"));
  CHECK(mentions(error_of(read(kCorners + "f 1 2 3\\\n\nv 0 x 0\n")).where, "a.obj:7"));
  CHECK(error_of(read(kCorners + "f 1 2 3 \\ 4\n")).error_class == ErrorClass::mesh);
  CHECK(read(kCorners + "f 1 2 3 \\"));
}

TEST_CASE("obj: names may hold a #") {
  const auto mesh = read("mtllib m.mtl\n" + kCorners + "usemtl red#1\nf 1 2 3\n", "newmtl red#1\nKd 1 0 0\n");
  REQUIRE(mesh);
  CHECK(mesh->material_names == std::vector<std::string>{"red#1"});
}

TEST_CASE("obj: file order across groups, objects and materials") {
  const auto mesh =
      read("mtllib m.mtl\n" + kCorners +
               "g a\nusemtl red\nf 1 2 3\ng b\nf 1 3 4\no c\nusemtl blue\nf 1 2 4\ng a\nusemtl red \nf 2 3 4\n",
           "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
  REQUIRE(mesh);
  CHECK(mesh->material_ids == std::vector<uint16_t>{0, 0, 1, 0});
  CHECK(mesh->source_primitives == std::vector<uint32_t>{0, 1, 2, 3});
  CHECK(mesh->triangles[3] == std::array<uint32_t, 3>{1, 2, 3});
  CHECK(mesh->warnings.empty());
}

TEST_CASE("obj: polygons") {
  SUBCASE("a convex one is a fan, and triangles are numbered as they come") {
    const auto mesh = read(kCorners + "f 1 2 3 4\nf 1 2 3\n");
    REQUIRE(mesh);
    REQUIRE(mesh->triangles.size() == 3);
    CHECK(mesh->triangles[1] == std::array<uint32_t, 3>{0, 2, 3});
    CHECK(mesh->source_primitives == std::vector<uint32_t>{0, 1, 2});
  }
  SUBCASE("a concave one is covered exactly") {
    const std::string arrow = "v 0 0 0\nv 2 1 0\nv 0 2 0\nv 1 1 0\n",
                      u = "v 0 0 0\nv 3 0 0\nv 3 3 0\nv 2 3 0\nv 2 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\n";
    for (const auto& [points, faces, area] : {std::tuple{arrow, "f 1 2 3 4\n", 1.0},
                                              {arrow, "f 4 3 2 1\n", -1.0},
                                              {arrow, "f 2 3 4 1\n", 1.0},
                                              {u, "f 1 2 3 4 5 6 7 8\n", 7.0}}) {
      const auto mesh = read(points + faces);
      REQUIRE(mesh);
      CHECK(area_xy(*mesh) == doctest::Approx(area));
      for (const auto& t : mesh->triangles) {
        const Vec3d a = mesh->positions[t[0]];
        CHECK(cross(mesh->positions[t[1]] - a, mesh->positions[t[2]] - a).z * area > 0);
      }
    }
  }
  SUBCASE("a concave one in any plane, of many corners, with no overlap") {
    // A comb: teeth of area 1 above a bar of area 2 * teeth; tilted so that no axis is its normal.
    const int teeth = 40;
    std::vector<Vec3d> outline;
    for (int i = teeth; i-- > 0;) {
      for (const Vec3d p :
           {Vec3d{2.0 * i + 2, 1, 0}, Vec3d{2.0 * i + 1, 1, 0}, Vec3d{2.0 * i + 1, 2, 0}, Vec3d{2.0 * i, 2, 0}}) {
        outline.push_back(p);
      }
    }
    outline.push_back({0, 0, 0});
    outline.push_back({2.0 * teeth, 0, 0});
    std::string points, face = "f";
    for (size_t i = 0; i < outline.size(); ++i) {
      const Vec3d p = outline[i];
      points += fmt::format("v {} {} {}\n", p.x, p.y, 0.5 * p.x - 0.25 * p.y);
      face += fmt::format(" {}", i + 1);
    }
    const auto mesh = read(points + face);
    REQUIRE(mesh);
    CHECK(mesh->triangles.size() == outline.size() - 2);
    CHECK(area_xy(*mesh) == doctest::Approx(3 * teeth));
    // No triangle is turned, so an area that is the polygon's leaves none to overlap.
    for (const auto& t : mesh->triangles) {
      const Vec3d a = mesh->positions[t[0]];
      CHECK(cross(mesh->positions[t[1]] - a, mesh->positions[t[2]] - a).z >= 0);
    }
  }
  SUBCASE("one without area, and one that crosses itself, keep all corners") {
    const auto mesh = read(kCorners + "v nan 0 0\nf 1 2 1 2 1\nf 1 3 2 4\nf 1 1 1 1\nf 1 2 5 3 4\n");
    REQUIRE(mesh);
    CHECK(mesh->triangles.size() == 3 + 2 + 2 + 3);
  }
  SUBCASE("fewer than three corners are no face") {
    const auto mesh = read(kCorners + "f 1 2\nf 1\nf 1 2 3\n");
    REQUIRE(mesh);
    CHECK(mesh->triangles.size() == 1);
    CHECK(mesh->warnings.size() == 1);
  }
}

TEST_CASE("obj: normals have length 1, and useless ones are no normals") {
  const auto mesh =
      read(kCorners +
           "vn 0 0 2\nvn 0 0 0\nvn nan 0 0\nvn 1e-200 0 0\nf 1//1 2//2 3//3\nf 1//4 2 3//-1\nf 1/7/1 2/7 3/7/1\n");
  REQUIRE(mesh);
  REQUIRE(mesh->normals.size() == 2);
  CHECK(mesh->normals[0] == Vec3f{0, 0, 1});
  CHECK(mesh->normals[1] == Vec3f{1, 0, 0});
  CHECK(mesh->normal_indices[0] == std::array<uint32_t, 3>{0, kNoIndex, kNoIndex});
  CHECK(mesh->normal_indices[1] == std::array<uint32_t, 3>{1, kNoIndex, 1});
  CHECK(mesh->normal_indices[2] == std::array<uint32_t, 3>{0, kNoIndex, 0});

  const auto relative = read(kCorners + "vt 0 0\nvn 0 0 1\nf -4/-1/-1 -3//-1 -2/1 -1\nvn 0 1 0\nf 1//-1 2//-2 3/1/2\n");
  REQUIRE(relative);
  CHECK(relative->normal_indices[0] == std::array<uint32_t, 3>{0, 0, kNoIndex});
  CHECK(relative->normal_indices[1] == std::array<uint32_t, 3>{0, kNoIndex, kNoIndex});
  CHECK(relative->normal_indices[2] == std::array<uint32_t, 3>{1, 0, 1});
}

TEST_CASE("mtl: values, defaults and what is wrong with them") {
  const std::string obj = "mtllib m.mtl\n" + kCorners + "f 1 2 3\nusemtl a\nf 1 2 4\n";
  const std::string mtl =
      "Kd 1 1 1\nnewmtl a\r\nKa 0 0 0\nKd 0.5 0.25 1\nKs 1 1 1\nNs 32\nKe 0 1.5 2\nnewmtl b\nKd -1 0.5 1e999\nNs -3\n";
  SUBCASE("as written") {
    const auto mesh = read(obj, mtl);
    REQUIRE(mesh);
    CHECK(mesh->material_names == std::vector<std::string>{"a", "b", "default"});
    CHECK(mesh->material_ids == std::vector<uint16_t>{2, 0});
    CHECK(mesh->materials[0] == Material{{0, 0, 0}, {0.5f, 0.25f, 1}, {1, 1, 1}, 32, {0, 1.5f, 2}});
    CHECK(mesh->materials[1].diffuse == Vec3f{0.8f, 0.5f, 0.8f});
    CHECK(mesh->materials[1].ambient == mesh->materials[1].diffuse);
    CHECK(mesh->materials[1].shininess == 1);
    CHECK(mesh->materials[1].emission == Vec3f{0, 0, 0});
    CHECK(mesh->materials[2] == Material{});
    CHECK(mesh->warnings.size() == 3);
  }
  SUBCASE("ambient from diffuse") {
    const auto mesh = read(obj, mtl, {.ambient_from_diffuse = true});
    REQUIRE(mesh);
    CHECK(mesh->materials[0].ambient == Vec3f{0.5f, 0.25f, 1});
  }
  SUBCASE("missing: one default material and warnings") {
    const auto mesh = read(obj);
    REQUIRE(mesh);
    CHECK(mesh->material_names == std::vector<std::string>{"default"});
    CHECK(mesh->material_ids == std::vector<uint16_t>{0, 0});
    REQUIRE(mesh->warnings.size() == 2);
    CHECK(mentions(mesh->warnings[0], "m.mtl"));
    CHECK(mentions(mesh->warnings[1], "'a'"));
  }
}

TEST_CASE("obj: faults say where they are") {
  const auto fault = [](const std::string& obj) { return error_of(read(obj)); };
  for (const std::string face : {"f 1 2 5", "f 1 2 0", "f 1 2 -5", "f 1 2 x", "f 1 2 99999999999", "f 1 2 4294967297",
                                 "f 1//1 2 3", "f 1 2 3 9 4"}) {
    CAPTURE(face);
    const Error error = fault(kCorners + "f 1 2 3\n\n" + face + "\n");
    CHECK(error.error_class == ErrorClass::mesh);
    CHECK(mentions(error.where, "a.obj:7"));
  }
  CHECK(mentions(fault(kCorners + "f 1 2 3\nf 1 2 5\n").what, "face 1 (from 0) uses vertex 5"));
  CHECK(mentions(fault("v 0 0\n").line(), "a.obj:1: 'v' needs three numbers"));
  CHECK(mentions(fault("v 0 0 0\nv 0 zero 0\n").line(), "a.obj:2: 'zero' is not a number"));
  for (const std::string empty : {"", "\n", "# nothing\n", "v 0 0 0\n"}) {
    CHECK(mentions(fault(empty).what, "no faces"));
  }
}

TEST_CASE("obj: what it depends on is what its mtllib lines name, there or not") {
  const test::TempFolder folder;
  folder.write("b.mtl", "newmtl red\nKd 1 0 0\n");
  folder.write("my own.mtl", "newmtl green\nKd 0 1 0\n");
  const std::string path = folder.write("a.obj",
                                        "mtllib a.mtl b.mtl\r\n  mtllib my\\ own.mtl \r\n# mtllib no.mtl\n"
                                        "mtllibrary\nmtllib b.mtl\nusemtl green\n" +
                                            kCorners + "f 1 2 3\nusemtl red\nf 1 3 4\n");
  const auto mesh = read_mesh(path, {});
  REQUIRE(mesh);
  CHECK(mesh->dependencies ==
        std::vector<std::string>{folder.file("a.mtl"), folder.file("b.mtl"), folder.file("my own.mtl")});
  CHECK(mesh->material_names == std::vector<std::string>{"red", "green"});
}
