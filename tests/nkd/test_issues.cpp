// One bad file for every row of kIssues, and the code that it must be told by.
#include <doctest/doctest.h>

#include <cstring>
#include <functional>
#include <limits>
#include <set>

#include "nkd/schema.h"
#include "object_bytes.h"
#include "sys/hash.h"

using namespace kd;
using namespace kd::test;
using nkd::Issue;

namespace {

constexpr int kBits = 12;
const float kNaN = std::numeric_limits<float>::quiet_NaN();

Contents good(int bits = kBits) { return Contents(soup_shape(bits, 40, Soup::mixed, 5), bits); }

/// With a float32 vertex that is none: coordinate 4 has these bits.
std::function<void(Contents&)> float_vertex(uint32_t bits) {
  return [bits](Contents& c) {
    c = good(24);
    c.store_floats(1);
    const Vec3u vertex = Contents::unpacked(c.vertices, 32)[1];
    Contents::replace(c.vertices, 32, 1, {vertex.x, bits, vertex.z});
  };
}

/// The first inner node behind the root, or leaf with references.
uint32_t first_node(const Contents& c, bool leaf) {
  for (uint32_t i = 2; i < c.nodes.size(); ++i) {
    if (is_leaf(c.nodes[i]) == leaf && (!leaf || reference_count(c.nodes[i]) > 0)) return i;
  }
  return 0;
}

/// Overwrites a scalar of the object's table; its own check, if it has one, comes before the header's checksum.
template <class T>
void set_field(std::string& bytes, flatbuffers::voffset_t field, T value) {
  flatbuffers::GetMutableRoot<flatbuffers::Table>(bytes.data())->SetField<T>(field, value, T{});
}

/// Makes the table say that it lacks a field.
void drop_field(std::string& bytes, flatbuffers::voffset_t field) {
  const auto* table = flatbuffers::GetRoot<flatbuffers::Table>(bytes.data());
  const size_t vtable = static_cast<size_t>(reinterpret_cast<const char*>(table->GetVTable()) - bytes.data());
  std::memset(bytes.data() + vtable + field, 0, sizeof(flatbuffers::voffset_t));
}

/// A row: what to do to good contents, or to a good file's bytes.
struct BadFile {
  Issue issue;
  std::function<void(Contents&)> contents;
  std::function<void(std::string&)> bytes;
};

void patch_u32(std::string& bytes, size_t at, uint32_t value) { std::memcpy(bytes.data() + at, &value, 4); }

/// Shifts a required section by 4 bytes without breaking the FlatBuffer: built again by hand, unaligned.
std::string misaligned() {
  const Contents c = good();
  flatbuffers::FlatBufferBuilder builder;
  const auto section = [&](const auto& v) { return builder.CreateVector(v.data(), v.size()); };
  const auto nodes =
      builder.CreateVectorOfStructs(reinterpret_cast<const nkd_schema::Node*>(c.nodes.data()), c.nodes.size());
  auto references = section(c.references);
  auto vertices = section(c.vertices);
  const auto triangles = section(c.triangles);
  // Three vectors of 4-byte elements, one of them shorter by one, cannot all be aligned by chance.
  const std::vector<uint32_t> shorter(c.source_primitives.begin() + 1, c.source_primitives.end());
  const auto sources = section(shorter);
  const auto provenance = nkd_schema::CreateProvenanceDirect(builder, "a", 1, "b", "c");
  const nkd_schema::Double3 origin(0, 0, 0), extent(1, 1, 1);
  const nkd_schema::Checksums checksums{};
  const nkd_schema::TreeStatistics tree{};
  nkd_schema::ObjectBuilder object(builder);
  object.add_version(nkd::kFormatVersion);
  object.add_bits(kBits);
  object.add_origin(&origin);
  object.add_extent(&extent);
  object.add_nodes(nodes);
  object.add_references(references);
  object.add_triangles(triangles);
  object.add_vertices(vertices);
  object.add_source_primitives(sources);
  object.add_checksums(&checksums);
  object.add_tree(&tree);
  object.add_provenance(provenance);
  nkd_schema::FinishObjectBuffer(builder, object.Finish());
  return {reinterpret_cast<const char*>(builder.GetBufferPointer()), builder.GetSize()};
}

/// A chain of 65 inner nodes: one too many.
void deepen(Contents& c) {
  c.nodes.clear();
  for (uint32_t i = 0; i <= 2 * kMaxDepth + 3; ++i) c.nodes.push_back(make_leaf(0, 0));
  for (uint32_t level = 0; level <= kMaxDepth; ++level) {
    c.nodes[level == 0 ? 0 : 2 * level] = make_inner(0, 100, 2 * level + 2);
  }
}

uint32_t lone_triangle_leaf(Contents& c) {
  // Takes every reference to triangle 0 from the leaf at the end of the references.
  const uint32_t leaf = first_node(c, true);
  c.nodes[leaf] = make_leaf(first_reference(c.nodes[leaf]), reference_count(c.nodes[leaf]) - 1);
  return leaf;
}

const std::vector<BadFile>& bad_files() {
  static const std::vector<BadFile> all{
      {Issue::not_nkd, {}, [](std::string& b) { b[4] = 'X'; }},
      {Issue::not_nkd, {}, [](std::string& b) { b.clear(); }},
      {Issue::not_nkd, {}, [](std::string& b) { b.resize(15); }},
      {Issue::version, {}, [](std::string& b) { set_field<uint32_t>(b, nkd_schema::Object::VT_VERSION, 1); }},
      {Issue::version,
       {},
       [](std::string& b) {  // whose sections are elsewhere
         set_field<uint32_t>(b, nkd_schema::Object::VT_VERSION, 1);
         set_field<uint32_t>(b, nkd_schema::Object::VT_NODES, 0x7ffffff0);
       }},
      {Issue::offsets, {}, [](std::string& b) { patch_u32(b, 0, 0x7ffffff0); }},
      {Issue::offsets, {}, [](std::string& b) { b.resize(b.size() / 2); }},
      {Issue::missing_section, {}, [](std::string& b) { drop_field(b, nkd_schema::Object::VT_ORIGIN); }},
      {Issue::missing_section, {}, [](std::string& b) { drop_field(b, nkd_schema::Object::VT_CHECKSUMS); }},
      {Issue::missing_section, [](Contents& c) { c.vertices.clear(); }, {}},
      {Issue::alignment, {}, [](std::string& b) { b = misaligned(); }},
      {Issue::bits, {}, [](std::string& b) { set_field<uint8_t>(b, nkd_schema::Object::VT_BITS, 25); }},
      {Issue::bits, {}, [](std::string& b) { set_field<uint8_t>(b, nkd_schema::Object::VT_BITS, 0); }},
      {Issue::box, [](Contents& c) { c.summary.lattice.origin.y = HUGE_VAL; }, {}},
      {Issue::box, [](Contents& c) { c.summary.lattice.extent.z = kNaN; }, {}},
      {Issue::box, [](Contents& c) { c.summary.lattice.extent.x = -1; }, {}},
      {Issue::displacement, [](Contents& c) { c.summary.max_displacement = kNaN; }, {}},
      {Issue::displacement, [](Contents& c) { c.summary.rms_displacement = -1e-9; }, {}},
      {Issue::vertex_form, [](Contents& c) { c.form = VertexForm::float32; }, {}},
      {Issue::vertex_form, [](Contents& c) { c.form = static_cast<VertexForm>(2); }, {}},
      {Issue::node_count, [](Contents& c) { c.nodes.resize(1); }, {}},
      {Issue::child_index, [](Contents& c) { c.nodes[0] = make_inner(0, 5, 0); }, {}},
      {Issue::child_index, [](Contents& c) { c.nodes[0] = make_inner(0, 5, 0, kUpperEmpty); }, {}},
      {Issue::child_index,
       [](Contents& c) { c.nodes[0] = make_inner(0, 5, static_cast<uint32_t>(c.nodes.size())); },
       {}},
      {Issue::child_index, [](Contents& c) { c.nodes[0] = make_inner(0, 5, kMaxChild - 1); }, {}},
      {Issue::child_index, [](Contents& c) { c.nodes[0] = make_inner(0, 5, 2, kLowerEmpty | kUpperEmpty); }, {}},
      {Issue::empty_leaf, [](Contents& c) { c.nodes[1] = make_inner(0, 5, 4); }, {}},
      {Issue::empty_leaf, [](Contents& c) { c.nodes[1] = make_leaf(0, 1); }, {}},
      {Issue::node_bits, [](Contents& c) { c.nodes[first_node(c, false)].link |= 3; }, {}},
      {Issue::node_bits, [](Contents& c) { c.nodes[first_node(c, true)].link |= 1; }, {}},
      {Issue::shared_child,
       [](Contents& c) { c.nodes = {make_inner(0, 5, 2), {}, make_inner(0, 1, 4), make_inner(0, 7, 4), {}, {}}; },
       {}},
      {Issue::unreached_node, [](Contents& c) { c.nodes.push_back({}); }, {}},
      {Issue::depth, deepen, {}},
      {Issue::plane, [](Contents& c) { c.nodes[0].word = std::bit_cast<uint32_t>(5.5f); }, {}},
      {Issue::plane, [](Contents& c) { c.nodes[0].word = std::bit_cast<uint32_t>(kNaN); }, {}},
      {Issue::plane, [](Contents& c) { c.nodes[0].word = std::bit_cast<uint32_t>(4096.0f); }, {}},
      {Issue::plane, [](Contents& c) { c.nodes[0].word = std::bit_cast<uint32_t>(-1.0f); }, {}},
      {Issue::leaf_range, [](Contents& c) { c.nodes[first_node(c, true)] = make_leaf(0xffffffff, 2); }, {}},
      {Issue::leaf_range, [](Contents& c) { c.nodes[first_node(c, true)] = make_leaf(0, kMaxLeafReferences); }, {}},
      {Issue::reference, [](Contents& c) { c.references.back() = 40; }, {}},
      {Issue::reference, [](Contents& c) { c.references[0] = 0xffffffff; }, {}},
      {Issue::corner,
       [](Contents& c) {
         Contents::replace(c.triangles, 7, 7, {0, 120, 1});
       },
       {}},
      {Issue::corner,
       [](Contents& c) {
         Contents::replace(c.triangles, 7, 39, {0, 1, 127});
       },
       {}},
      {Issue::corner,
       [](Contents& c) {
         Contents::replace(c.triangles, 7, 0, {120, 0, 1});
       },
       {}},
      {Issue::vertex_size, [](Contents& c) { c.vertices.push_back(0); }, {}},
      {Issue::vertex_size, [](Contents& c) { c.vertices.resize(kTripleMargin); }, {}},
      {Issue::vertex_size, [](Contents& c) { c.vertices.resize(3); }, {}},
      {Issue::triangle_size, [](Contents& c) { c.triangles.push_back(0); }, {}},
      {Issue::triangle_size, [](Contents& c) { c.triangles.resize(kTripleMargin); }, {}},
      {Issue::vertex_value, float_vertex(std::bit_cast<uint32_t>(kNaN)), {}},
      {Issue::vertex_value, float_vertex(std::bit_cast<uint32_t>(HUGE_VALF)), {}},
      {Issue::vertex_value, float_vertex(std::bit_cast<uint32_t>(16777216.0f)), {}},
      {Issue::vertex_value, float_vertex(std::bit_cast<uint32_t>(-1e-30f)), {}},
      {Issue::vertex_value, float_vertex(std::bit_cast<uint32_t>(-0.0f)), {}},
      {Issue::source_primitives, [](Contents& c) { c.source_primitives.pop_back(); }, {}},
      {Issue::normals, [](Contents& c) { c.normal_indices.resize(c.normal_indices.size() - 3); }, {}},
      {Issue::normals, [](Contents& c) { c.normal_indices[5] = 3; }, {}},
      {Issue::normal_value, [](Contents& c) { c.normals[1].y = kNaN; }, {}},
      {Issue::materials, [](Contents& c) { c.material_ids.pop_back(); }, {}},
      {Issue::materials, [](Contents& c) { c.material_ids[3] = 2; }, {}},
      {Issue::material_value, [](Contents& c) { c.materials[1].diffuse.x = -1; }, {}},
      {Issue::material_value, [](Contents& c) { c.materials[0].shininess = kNaN; }, {}},
      {Issue::material_value, [](Contents& c) { c.materials[0].emission.y = -1; }, {}},
      {Issue::checksum, {}, [](std::string& b) { bytes_of(b, good().references)[0] ^= 1; }},
      {Issue::checksum, {}, [](std::string& b) { bytes_of(b, good().material_ids)[0] ^= 1; }},
      {Issue::plane_outside,
       [](Contents& c) {
         const int axis = split_axis(c.nodes[0]);
         c.nodes = {make_inner(axis, 2000, 2), {}, make_inner(axis, 2001, 4), {}, {}, {}};
       },
       {}},
      {Issue::foreign_reference,
       [](Contents& c) {
         // Every leaf knows every triangle.
         const auto first = static_cast<uint32_t>(c.references.size());
         for (uint32_t i = 0; i < 40; ++i) c.references.push_back(i);
         for (uint32_t i = 2; i < c.nodes.size(); ++i) {
           if (is_leaf(c.nodes[i])) c.nodes[i] = make_leaf(first, 40);
         }
       },
       {}},
      {Issue::missing_reference, [](Contents& c) { lone_triangle_leaf(c); }, {}},
      {Issue::missing_reference,
       [](Contents& c) {
         c.nodes = {make_leaf(0, 0), {}};
       },
       {}},
      {Issue::unordered_leaf,
       [](Contents& c) {
         c.nodes = {make_leaf(0, 40), {}};
         for (uint32_t i = 0; i < 40; ++i) c.references[i] = 39 - i;
       },
       {}},
      {Issue::unordered_leaf,
       [](Contents& c) {
         c.nodes = {make_leaf(0, 41), {}};
         c.references.assign(41, 0);
         for (uint32_t i = 0; i < 40; ++i) c.references[i + 1] = i;
       },
       {}},
      {Issue::file_size, {}, [](std::string& b) { b.push_back(0); }},
      {Issue::file_size, {}, [](std::string& b) { set_field<uint64_t>(b, nkd_schema::Object::VT_FILE_BYTES, 7); }},
      {Issue::header_checksum,
       {},
       [](std::string& b) { set_field<double>(b, nkd_schema::Object::VT_RMS_DISPLACEMENT, 0.125); }},
      {Issue::statistics, [](Contents& c) { c.summary.tree.sah_cost *= 1 + 1e-12; }, {}},
      {Issue::statistics, [](Contents& c) { ++c.summary.tree.depth; }, {}},
  };
  return all;
}

}  // namespace

TEST_CASE("nkd: the good file is sound") {
  const TempFolder folder;
  for (const int bits : {6, 10, 12, 21, 23, 24}) {
    CHECK(verdict(good(bits).write(folder.file("a.nkd"))) == "sound");
    CHECK(verdict(Contents(rooms_shape(bits, 4, 5), bits).write(folder.file("a.nkd"))) == "sound");
    CHECK(verdict(Contents(stacked_boxes_shape(bits, 3), bits).write(folder.file("a.nkd"))) == "sound");
  }
  Contents floats = good(24);
  floats.store_floats(1);
  CHECK(verdict(floats.write(folder.file("a.nkd"))) == "sound");
}

TEST_CASE("nkd: every issue has a bad file, which is told by its code") {
  const TempFolder folder;
  std::set<Issue> covered;
  int number = 0;
  for (const BadFile& bad : bad_files()) {
    ++number;
    CAPTURE(number);
    CAPTURE(static_cast<int>(bad.issue));
    Contents c = good();
    if (bad.contents) {
      bad.contents(c);
      // Only a check of the statistics is to see that they are wrong.
      if (bad.issue >= Issue::plane_outside && bad.issue != Issue::statistics) c.count_tree();
    }
    std::string bytes = read_bytes(c.write(folder.file("a.nkd")));
    if (bad.bytes) bad.bytes(bytes);
    CHECK(verdict(folder.write("b.nkd", bytes)) == "NKD" + std::to_string(static_cast<int>(bad.issue)));
    covered.insert(bad.issue);
  }
  for (const nkd::IssueRow& row : nkd::kIssues) {
    CAPTURE(row.text);
    CHECK(covered.count(row.issue) == 1);
    CHECK(nkd::issue_text(row.issue) == row.text);
  }
}

TEST_CASE("nkd: an absent section is told as absent, not as a bad offset") {
  const TempFolder folder;
  const std::string bytes = read_bytes(good().write(folder.file("a.nkd")));
  for (const auto field : {nkd_schema::Object::VT_NODES, nkd_schema::Object::VT_REFERENCES,
                           nkd_schema::Object::VT_TRIANGLES, nkd_schema::Object::VT_VERTICES}) {
    CAPTURE(static_cast<int>(field));
    std::string bad = bytes;
    drop_field(bad, field);
    CHECK(verdict(folder.write("b.nkd", bad)) == "NKD104");
  }
}

TEST_CASE("nkd: an issue's line has its code, its text and where") {
  CHECK(nkd::Finding{Issue::leaf_range, "node 12"}.line() ==
        "NKD307: a leaf's references lie outside their section (node 12)");
  CHECK(nkd::Finding{Issue::box, ""}.line().find('(') == std::string::npos);
}

TEST_CASE("nkd: validation tells each kind of fault once, all of them together") {
  const TempFolder folder;
  Contents c = good();
  lone_triangle_leaf(c);
  c.normals[0].x = kNaN;
  ++c.summary.tree.leaves;
  const auto file = nkd::ObjectFile::open(c.write(folder.file("a.nkd")));
  REQUIRE(file);
  std::vector<Issue> found;
  for (const nkd::Finding& f : nkd::validate(*file)) found.push_back(f.issue);
  CHECK(found == std::vector<Issue>{Issue::normal_value, Issue::missing_reference, Issue::statistics});
}
