// Writing and opening: every section comes back, and the same contents are the same bytes.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>

#include "object_bytes.h"

using namespace kd;
using namespace kd::test;

namespace {

template <class A, class B>
bool same(const A& a, const B& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

}  // namespace

TEST_CASE("nkd: every section comes back, at every vertex width") {
  const TempFolder folder;
  for (const int bits : {6, 10, 16, 21, 24}) {
    CAPTURE(bits);
    Contents c(soup_shape(bits, 300, Soup::mixed, 1), bits);
    c.summary.lattice.origin = {-1.5, 1e6, 1e-9};
    c.summary.lattice.extent = {1, 1e-3, 1e12};
    c.count_tree();
    const auto file = nkd::ObjectFile::open(c.write(folder.file("a.nkd")));
    REQUIRE(file);
    CHECK(file->size() == std::filesystem::file_size(file->path()));
    CHECK(same(file->geometry().nodes, c.nodes));
    CHECK(same(file->geometry().references, c.references));
    CHECK(same(file->geometry().triangles, c.triangles));
    CHECK(same(file->geometry().vertices, c.vertices));
    CHECK(file->geometry().triangle_count() == 300);
    for (const void* section : {static_cast<const void*>(file->geometry().nodes.data()),
                                static_cast<const void*>(file->geometry().references.data()),
                                static_cast<const void*>(file->geometry().triangles.data()),
                                static_cast<const void*>(file->geometry().vertices.data())}) {
      CHECK(reinterpret_cast<uintptr_t>(section) % 16 == 0);
    }
    const nkd::Summary& s = file->summary();
    CHECK(s.lattice.bits == bits);
    CHECK(s.lattice.origin == c.summary.lattice.origin);
    CHECK(s.lattice.extent == c.summary.lattice.extent);
    CHECK(s.max_displacement == 0.5);
    CHECK(s.rms_displacement == 0.25);
    CHECK(s.tree == c.summary.tree);
    CHECK(s.provenance.source_name == "shape.ply");
    CHECK(s.provenance.source_hash == 0x0123456789abcdefull);
    CHECK(s.provenance.settings == "--bits " + std::to_string(bits));
    CHECK(s.provenance.writer == "test 1");
    CHECK(s.material_names == c.summary.material_names);
    CHECK_FALSE(s.emissive);

    CHECK(file->has_normals());
    CHECK(file->has_materials());
    CHECK(file->has_source_primitives());
    REQUIRE(file->normals());
    CHECK(same(file->normals()->values, c.normals));
    CHECK(same(file->normals()->indices, c.normal_indices));
    REQUIRE(file->materials());
    CHECK(same(file->materials()->values, c.materials));
    CHECK(same(file->materials()->ids, c.material_ids));
    REQUIRE(file->source_primitives());
    CHECK(same(*file->source_primitives(), c.source_primitives));
    CHECK(file->check_attributes().empty());
  }
}

TEST_CASE("nkd: float32 vertices come back, and as the lattice points that the tree knows") {
  const TempFolder folder;
  const Shape shape = soup_shape(24, 300, Soup::mixed, 1);
  Contents c(shape, 24);
  c.store_floats(7);
  const auto file = nkd::ObjectFile::open(c.write(folder.file("a.nkd")));
  REQUIRE(file);
  const nkd::Geometry& g = file->geometry();
  CHECK(g.form == VertexForm::float32);
  CHECK(same(g.vertices, c.vertices));
  REQUIRE(g.vertex_count() == shape.vertices.size());
  CHECK(g.vertices.size_bytes() == 12 * shape.vertices.size() + kTripleMargin);
  int off_lattice = 0;
  for (size_t i = 0; i < shape.vertices.size(); ++i) {
    const Vec3f p = g.packed().position(i);
    float stored[3];
    std::memcpy(stored, &c.vertices[12 * i], sizeof stored);
    REQUIRE(p == Vec3f{stored[0], stored[1], stored[2]});
    REQUIRE(g.packed().lattice_point(i) == shape.vertices[i]);
    off_lattice += !(p == vec_cast<float>(shape.vertices[i]));
  }
  CHECK(off_lattice > 200);
  for (size_t i = 0; i < g.triangle_count(); ++i) {
    TriangleVertices t;
    g.packed().expand(i, t);
    REQUIRE(t.a == g.packed().position(shape.triangles[i][0]));
    REQUIRE(t.b == g.packed().position(shape.triangles[i][1]));
    REQUIRE(t.c == g.packed().position(shape.triangles[i][2]));
  }
  Contents lattice(shape, 24);
  CHECK(nkd::ObjectFile::open(lattice.write(folder.file("b.nkd")))->geometry().form == VertexForm::lattice);
}

TEST_CASE("nkd: attributes that an object does not have") {
  const TempFolder folder;
  const Contents c(box_shape({0, 0, 0}, {1023, 1023, 1023}), 10, false);
  const auto file = nkd::ObjectFile::open(c.write(folder.file("a.nkd")));
  REQUIRE(file);
  CHECK_FALSE(file->has_normals());
  CHECK_FALSE(file->has_materials());
  CHECK_FALSE(file->has_source_primitives());
  CHECK(file->normals()->indices.empty());
  CHECK(file->materials()->ids.empty());
  CHECK(file->source_primitives()->empty());
  CHECK(nkd::validate(*file).empty());
}

TEST_CASE("nkd: a corrupt attribute is no obstacle until it is asked for") {
  const TempFolder folder;
  const Contents c(box_shape({0, 0, 0}, {1023, 1023, 1023}), 10);
  const std::string good = read_bytes(c.write(folder.file("a.nkd")));
  std::string bytes = good;
  char* normals = bytes_of(bytes, c.normals);
  REQUIRE(normals);
  normals[0] ^= 1;
  const auto file = nkd::ObjectFile::open(folder.write("b.nkd", bytes));
  REQUIRE(file);
  CHECK(file->has_normals());
  CHECK(file->materials());
  CHECK(file->source_primitives());
  const auto asked = file->normals();
  REQUIRE_FALSE(asked);
  CHECK(asked.error().error_class == ErrorClass::object);
  CHECK(asked.error().what.substr(0, 6) == "NKD601");
  CHECK(asked.error().where == file->path());
}

TEST_CASE("nkd: the same contents are the same bytes") {
  const TempFolder folder;
  const Shape shape = soup_shape(21, 500, Soup::mixed, 3);
  const std::string first = read_bytes(Contents(shape, 21).write(folder.file("a.nkd")));
  CHECK(first == read_bytes(Contents(shape, 21).write(folder.file("b.nkd"))));
  // Over a file that is there.
  CHECK(first == read_bytes(Contents(shape, 21).write(folder.file("a.nkd"))));
  CHECK(first != read_bytes(Contents(soup_shape(21, 500, Soup::mixed, 4), 21).write(folder.file("c.nkd"))));
}

TEST_CASE("nkd: what cannot be read or written") {
  const TempFolder folder;
  const auto missing = nkd::ObjectFile::open(folder.file("none.nkd"));
  REQUIRE_FALSE(missing);
  CHECK(missing.error().error_class == ErrorClass::missing);
  CHECK_FALSE(nkd::ObjectFile::open(folder.file("")));
  const Contents c(box_shape({0, 0, 0}, {1023, 1023, 1023}), 10);
  const auto unwritten = nkd::write_object(folder.file("no/such/folder.nkd"), c.summary, c.geometry(), {});
  REQUIRE_FALSE(unwritten);
  CHECK(unwritten.error().error_class == ErrorClass::output);
}

TEST_CASE("round trip: the header says whether some material has emission") {
  const TempFolder folder;
  Contents c(box_shape({0, 0, 0}, {1023, 1023, 1023}), 10);
  c.materials[1].emission = {0, 2, 0.5f};
  const std::string path = c.write(folder.file("lamp.nkd"));
  const auto file = nkd::ObjectFile::open(path);
  REQUIRE(file);
  CHECK(file->summary().emissive);
  REQUIRE(file->materials());
  CHECK(file->materials()->values[1] == c.materials[1]);
  CHECK(verdict(path) == "sound");
}
