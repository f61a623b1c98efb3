// Everything that can be wrong with a .nkd: a stable code and a text each. To add one: a row here, the check that finds
// it, and a bad file in tests/nkd/.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace kd::nkd {

enum class Issue : uint16_t {
  not_nkd = 101,
  version = 102,
  offsets = 103,
  missing_section = 104,
  alignment = 105,
  file_size = 106,
  bits = 201,
  box = 202,
  displacement = 203,
  vertex_form = 204,
  node_count = 301,
  child_index = 302,
  shared_child = 303,
  unreached_node = 304,
  depth = 305,
  plane = 306,
  leaf_range = 307,
  empty_leaf = 308,
  node_bits = 309,
  reference = 401,
  corner = 402,
  vertex_size = 403,
  triangle_size = 405,
  vertex_value = 406,
  source_primitives = 501,
  normals = 502,
  normal_value = 503,
  materials = 504,
  material_value = 505,
  checksum = 601,
  header_checksum = 602,
  plane_outside = 701,
  foreign_reference = 702,
  missing_reference = 703,
  unordered_leaf = 704,
  statistics = 705,
};

struct IssueRow {
  Issue issue;
  std::string_view text;
};

inline constexpr std::array kIssues{
    IssueRow{Issue::not_nkd, "not a .nkd file, or cut off in its header"},
    IssueRow{Issue::version, "a format version this program does not read: compile the mesh again"},
    IssueRow{Issue::offsets, "an offset points outside the file: it is truncated or corrupt"},
    IssueRow{Issue::missing_section, "a required section is absent or empty"},
    IssueRow{Issue::alignment, "a section does not start at a 16-byte boundary"},
    IssueRow{Issue::file_size, "the file is not as long as it says: bytes were cut off or added"},
    IssueRow{Issue::bits, "the lattice's bits are not in 1..24"},
    IssueRow{Issue::box, "the box's origin or extent is not finite, or an extent is negative"},
    IssueRow{Issue::displacement, "a recorded displacement is not finite, or negative"},
    IssueRow{Issue::vertex_form, "the vertices' form is unknown, or is float32 on a lattice that has not 24 bits"},
    IssueRow{Issue::node_count, "the number of nodes is below 2 or above 2^27"},
    IssueRow{Issue::child_index, "a child's index is out of range or not above its parent's, or both are empty"},
    IssueRow{Issue::shared_child, "two nodes have the same child"},
    IssueRow{Issue::unreached_node, "a node has no parent"},
    IssueRow{Issue::depth, "a path is longer than 64 nodes"},
    IssueRow{Issue::plane, "a split plane is not a lattice coordinate"},
    IssueRow{Issue::leaf_range, "a leaf's references lie outside their section"},
    IssueRow{Issue::empty_leaf, "node 1, which stands for all empty children, is not an empty leaf"},
    IssueRow{Issue::node_bits, "a node's lowest bits are neither an axis nor a leaf's"},
    IssueRow{Issue::reference, "a reference names a triangle that does not exist"},
    IssueRow{Issue::corner, "a triangle's corner names a vertex that does not exist"},
    IssueRow{Issue::vertex_size, "the vertex section is not a whole number of vertices, at least one, and 16 bytes"},
    IssueRow{Issue::triangle_size, "the triangle section is not a whole number of triangles"},
    IssueRow{Issue::vertex_value, "a float32 vertex is not finite, or lies outside the cube [0, 2^24 - 1]"},
    IssueRow{Issue::source_primitives, "the source primitives are not one a triangle"},
    IssueRow{Issue::normals, "the normal indices are not one a corner, or name a normal that does not exist"},
    IssueRow{Issue::normal_value, "a normal is not finite"},
    IssueRow{Issue::materials, "the material ids are not one a triangle, or name a material that does not exist"},
    IssueRow{Issue::material_value, "a material's value is not finite, or negative"},
    IssueRow{Issue::checksum, "a section's checksum does not match: it is corrupt"},
    IssueRow{Issue::header_checksum, "the header's checksum does not match: it is corrupt"},
    IssueRow{Issue::plane_outside, "a split plane lies outside its cell"},
    IssueRow{Issue::foreign_reference, "a leaf refers to a triangle that is more than a lattice step from its cell"},
    IssueRow{Issue::missing_reference, "a triangle passes through a leaf's cell that does not refer to it"},
    IssueRow{Issue::unordered_leaf, "a leaf's references are not ascending"},
    IssueRow{Issue::statistics, "the recorded tree statistics are not the tree's"},
};

/// One thing found wrong, and where in the file.
struct Finding {
  Issue issue;
  std::string detail;

  /// "NKD307: a leaf's references lie outside their section (node 12)".
  std::string line() const;
};

std::string_view issue_text(Issue issue);

}  // namespace kd::nkd
