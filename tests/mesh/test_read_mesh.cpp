// PLY, STL and OFF files, sound and broken; the table of formats; the real meshes.
#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

#include "mesh/read_mesh.h"
#include "support/temp_folder.h"

using namespace kd;
using namespace kd::mesh;

namespace {

Result<Mesh> read(const std::string& name, const std::string& contents) {
  const test::TempFolder folder;
  return read_mesh(folder.write(name, contents), {});
}

Error error_of(const Result<Mesh>& result) {
  REQUIRE_FALSE(result);
  return result.error();
}

bool mentions(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

template <class T>
std::string raw(std::initializer_list<T> values, bool big_endian = false) {
  std::string bytes;
  for (const T value : values) {
    std::string one(sizeof(T), 0);
    std::memcpy(one.data(), &value, sizeof(T));
    bytes += big_endian ? std::string(one.rbegin(), one.rend()) : one;
  }
  return bytes;
}

std::string ply_header(const std::string& format, const std::string& type, const std::string& vertices = "3",
                       const std::string& faces = "1", const std::string& list = "uchar int") {
  return "ply\nformat " + format + " 1.0\ncomment made by hand\nelement vertex " + vertices + "\nproperty " + type +
         " x\nproperty " + type + " y\nproperty " + type + " z\nproperty uchar red\nelement face " + faces +
         "\nproperty list " + list + " vertex_index\nend_header\n";
}

const std::string kTextData = "0 0 0 9\n1 0 0 9\n0 1 0 9\n3 0 1 2\n";

std::string stl_facet(std::initializer_list<float> corners) {
  return raw<float>({0, 0, 1}) + raw<float>(corners) + raw<uint16_t>({0});
}

}  // namespace

TEST_CASE("read_mesh: chooses by extension and says what it cannot read") {
  CHECK(read("a.PLY", ply_header("ascii", "float") + kTextData));
  CHECK(read("a.Off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2"));
  const Error unknown = error_of(read("a.fbx", ""));
  CHECK(unknown.error_class == ErrorClass::mesh);
  CHECK(mentions(unknown.what, ".obj"));
  CHECK(mentions(supported_formats(), ".stl"));
  CHECK(error_of(read_mesh("/nowhere/a.ply", {})).error_class == ErrorClass::missing);
  CHECK(error_of(read_mesh("/tmp", {})).error_class == ErrorClass::missing);
  for (const std::string name : {"a.ply", "a.stl", "a.off", "a.obj"}) {
    CHECK(error_of(read(name, "")).error_class == ErrorClass::mesh);
    CHECK(error_of(read(name, std::string(100, '\0'))).error_class == ErrorClass::mesh);
  }
}

TEST_CASE("ply: text and both byte orders, float and double, in full") {
  const double third = 1.0 / 3, far = 1e6 + 0.123456789;
  const auto check = [&](const Result<Mesh>& mesh, bool in_double) {
    REQUIRE(mesh);
    const auto narrow = [&](double v) { return in_double ? v : static_cast<double>(static_cast<float>(v)); };
    CHECK(mesh->positions[0] == Vec3d{narrow(0.1), narrow(third), 0});
    CHECK(mesh->positions[1] == Vec3d{narrow(far), 1, 2});
    CHECK(mesh->triangles == std::vector<std::array<uint32_t, 3>>{{0, 1, 2}});
    CHECK(mesh->normals.empty());
  };
  std::ostringstream text;
  text.precision(17);
  text << "0.1 " << third << " 0 9\n" << far << " 1 2 9\n0 0 5 9\n3 0 1 2";
  check(read("a.ply", ply_header("ascii", "float") + text.str()), false);
  check(read("a.ply", ply_header("ascii", "double") + text.str()), true);
  for (const bool big : {false, true}) {
    const std::string format = big ? "binary_big_endian" : "binary_little_endian", colour(1, '\7');
    const std::string face = std::string(1, '\3') + raw<int32_t>({0, 1, 2}, big);
    const auto f = [&](double x, double y, double z) {
      return raw<float>({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)}, big) + colour;
    };
    const auto d = [&](double x, double y, double z) { return raw<double>({x, y, z}, big) + colour; };
    check(read("a.ply", ply_header(format, "float") + f(0.1, third, 0) + f(far, 1, 2) + f(0, 0, 5) + face), false);
    check(read("a.ply", ply_header(format, "double") + d(0.1, third, 0) + d(far, 1, 2) + d(0, 0, 5) + face), true);
  }
}

TEST_CASE("ply: CR LF, normals, polygons, degenerate and non-manifold faces are all kept") {
  const auto mesh =
      read("a.ply",
           "ply\r\nformat ascii 1.0\r\nelement vertex 4\r\nproperty float x\r\nproperty float y\r\nproperty "
           "float z\r\nproperty float nx\r\nproperty float ny\r\nproperty float nz\r\nelement face 6\r\n"
           "property list uint8 uint32 vertex_indices\r\nend_header\r\n0 0 0 0 0 2\r\n1 0 0 0 0 0\r\n"
           "1 1 0 0 0 1\r\n0 1 0 0 0 1\r\n4 0 1 2 3\r\n3 0 1 2\r\n3 0 1 2\r\n3 2 1 0\r\n3 0 0 1\r\n2 0 1\r\n");
  REQUIRE(mesh);
  REQUIRE(mesh->triangles.size() == 6);
  CHECK(mesh->triangles[1] == std::array<uint32_t, 3>{0, 2, 3});
  CHECK(mesh->triangles[5] == std::array<uint32_t, 3>{0, 0, 1});
  CHECK(mesh->source_primitives == std::vector<uint32_t>{0, 1, 2, 3, 4, 5});
  CHECK(mesh->normals[0] == Vec3f{0, 0, 1});
  CHECK(mesh->normal_indices[0] == std::array<uint32_t, 3>{0, kNoIndex, 1});
  CHECK(mesh->warnings.size() == 1);
}

TEST_CASE("ply: a vertex that is not a number is kept in binary") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::string c(1, '\0');
  const auto mesh =
      read("a.ply", ply_header("binary_little_endian", "float") + raw<float>({nan, 0, 0}) + c + raw<float>({1, 0, 0}) +
                        c + raw<float>({0, 1, 0}) + c + std::string(1, '\3') + raw<int32_t>({0, 1, 2}));
  REQUIRE(mesh);
  CHECK(std::isnan(mesh->positions[0].x));
}

TEST_CASE("ply: faults") {
  const auto fault = [](const std::string& contents) {
    const Error error = error_of(read("a.ply", contents));
    CHECK(error.error_class == ErrorClass::mesh);
    return error.line();
  };
  CHECK(mentions(fault(ply_header("ascii", "float", "4000000000") + kTextData), "truncated"));
  CHECK(mentions(fault(ply_header("binary_little_endian", "float", "3", "4000000000") + std::string(60, '\0')),
                 "truncated"));
  CHECK(mentions(fault(ply_header("ascii", "float", "-3") + kTextData), "no count"));
  CHECK(mentions(fault(ply_header("ascii", "int") + kTextData), "float type"));
  CHECK(mentions(fault(ply_header("ebcdic", "float") + kTextData), "a.ply:2"));
  CHECK(mentions(fault("ply\nformat ascii 1.0\n"), "end_header"));
  CHECK(mentions(fault("plyx\n"), "not 'ply'"));
  CHECK(mentions(fault(ply_header("ascii", "float") + "0 0 0 9\n1 zero 0 9\n0 1 0 9\n3 0 1 2\n"), "a.ply:13"));
  CHECK(mentions(fault(ply_header("ascii", "float") + "0 0 0 9\n1 0 0 9\n0 1 0 9\n3 0 1 3\n"),
                 "face 0 (from 0) uses vertex 3"));
  CHECK(mentions(fault(ply_header("ascii", "float") + "0 0 0 9\n1 0 0 9\n0 1 0 9\n3 0 1 -1\n"), "vertex -1"));
  CHECK(mentions(fault(ply_header("ascii", "float") + "0 0 0 9\n1 0 0 9\n0 1 0 9\n-3 0 1 2\n"), "truncated"));
  CHECK(mentions(fault(ply_header("ascii", "float", "3", "0") + "0 0 0 9\n1 0 0 9\n0 1 0 9\n"), "no faces"));
  CHECK(mentions(fault(ply_header("ascii", "float") + "0 0 0 9\n1 0 0 9\n0 1 0 9\n3 0"), "truncated"));
  const std::string vertices(39, '\0');
  CHECK(mentions(
      fault(ply_header("binary_little_endian", "float", "3", "1", "int int") + vertices + raw<int32_t>({-1, 0, 0, 0})),
      "truncated"));
  CHECK(mentions(
      fault(ply_header("binary_little_endian", "float") + vertices + std::string(1, '\3') + raw<int32_t>({0, 1})),
      "truncated"));
}

TEST_CASE("stl: text and binary keep every triangle and join equal corners") {
  const auto binary = [](const std::string& comment, uint32_t count, const std::string& facets) {
    std::string header = comment;
    header.resize(80, ' ');
    return header + raw<uint32_t>({count}) + facets;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::string facets = stl_facet({0, 0, 0, 1, 0, 0, 0, 1, 0}) + stl_facet({1, 0, 0, 1, 1, 0, -0.0f, 1, 0}) +
                             stl_facet({0, 0, 0, 0, 0, 0, 1, 0, 0}) + stl_facet({nan, 0, 0, 1, 0, 0, 0, 1, 0});
  for (const std::string comment : {"made by hand", "solid but binary"}) {
    const auto mesh = read("a.stl", binary(comment, 4, facets));
    REQUIRE(mesh);
    REQUIRE(mesh->triangles.size() == 4);
    CHECK(mesh->positions.size() == 5);
    CHECK(mesh->triangles[1] == std::array<uint32_t, 3>{1, 3, 2});
    CHECK(mesh->triangles[2] == std::array<uint32_t, 3>{0, 0, 1});
    CHECK(std::isnan(mesh->positions[mesh->triangles[3][0]].x));
  }
  const std::string text =
      "solid vertex of a name\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   VERTEX 1 0 0\n   vertex 0 0.1 "
      "1e-3\n  endloop\n endfacet\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 0\nvertex 1 0 0\nendloop\n"
      "endfacet\nendsolid vertex\n";
  const auto mesh = read("a.stl", text);
  REQUIRE(mesh);
  CHECK(mesh->triangles == std::vector<std::array<uint32_t, 3>>{{0, 1, 2}, {0, 0, 1}});
  CHECK(mesh->positions[2] == Vec3d{0, 0.1, 1e-3});

  CHECK(mentions(error_of(read("a.stl", text.substr(0, 90))).line(), "a.stl:"));
  CHECK(mentions(error_of(read("a.stl", text.substr(0, 150))).what, "truncated"));
  CHECK(mentions(error_of(read("a.stl", binary("x", 4, facets.substr(0, 100)))).what, "truncated"));
  CHECK(mentions(error_of(read("a.stl", binary("x", 4000000000u, facets))).what, "truncated"));
  CHECK(mentions(error_of(read("a.stl", "solid a\nendsolid a\n")).what, "no faces"));
}

TEST_CASE("off: comments, colours, doubles and faults") {
  const auto mesh =
      read("a.off",
           "# a comment\r\nCOFF # another\r\n\r\n4 2 0\r\n0.1 0 0 255 0 0\r\n# one more\r\n1e6 0 0 0 0 0\r\n1 1 "
           "0\r\n0 1 1000000.123456789\r\n4 0 1 2 3 0.5 0.5 0.5\r\n3 0 1 1 # red");
  REQUIRE(mesh);
  CHECK(mesh->triangles.size() == 3);
  CHECK(mesh->triangles[2] == std::array<uint32_t, 3>{0, 1, 1});
  CHECK(mesh->positions[0].x == 0.1);
  CHECK(mesh->positions[3].z == 1000000.123456789);

  const auto fault = [](const std::string& contents) { return error_of(read("a.off", contents)).line(); };
  CHECK(mentions(fault("OFF\n4000000000 1 0\n"), "cannot be in"));
  CHECK(mentions(fault("OFF\n3 1 0\n0 0 0\n0 1 x\n"), "a.off:4"));
  CHECK(mentions(fault("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"), "a.off:6: face 0 (from 0) uses vertex 3"));
  CHECK(mentions(fault("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n"), "face 0 has 2 of 3"));
  CHECK(mentions(fault("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n"), "number of corners"));
  CHECK(mentions(fault("OFF BINARY\n"), "binary OFF"));
  CHECK(mentions(fault("4OFF\n"), "keyword"));
  CHECK(mentions(fault("OFF\n0 0 0\n"), "no faces"));
}

TEST_CASE("ply: the bunny, bit for bit what a naive reading gives") {
  const std::string path = std::string(KD_SOURCE_DIR) + "/../shared/data/bunny.ply";
  if (!std::filesystem::exists(path)) {
    MESSAGE("skipped: no " << path);
    return;
  }
  std::ifstream in(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string mark = "end_header\n";
  const char* at = text.data() + text.find(mark) + mark.size();
  const auto mesh = read_mesh(path, {});
  REQUIRE(mesh);
  REQUIRE(mesh->positions.size() == 34834);
  REQUIRE(mesh->triangles.size() == 69451);
  size_t differences = 0;
  for (const Vec3d& p : mesh->positions) {
    float v[3];
    std::memcpy(v, at, sizeof v);
    at += sizeof v;
    const Vec3d expected{v[0], v[1], v[2]};
    differences += std::memcmp(&p, &expected, sizeof p) != 0;
  }
  for (const auto& t : mesh->triangles) {
    differences += *at != 3 || std::memcmp(t.data(), at + 1, sizeof t) != 0;
    at += 1 + sizeof t;
  }
  CHECK(differences == 0);
  CHECK(at == text.data() + text.size());
}
