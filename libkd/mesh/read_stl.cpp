// STL, by hand: OpenMesh's reader leaves out triangles with two equal corners, gives a NaN vertex the place of another
// one, and takes a binary file whose comment begins with "solid" for an empty text. Corners in one place become one
// vertex, numbered by first use; a facet's normal and colour are not kept.
#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "mesh/formats.h"
#include "mesh/mesh_builder.h"
#include "mesh/text.h"
#include "mesh/weld.h"

namespace kd::mesh {
namespace {

constexpr size_t kHeaderSize = 84;  // a comment of 80 bytes and the number of triangles
constexpr size_t kFacetSize = 50;   // normal and three corners in float32, two bytes of anything

float load_float(const std::byte* from) {
  uint32_t bits = 0;
  for (int i = 3; i >= 0; --i) bits = bits << 8 | std::to_integer<uint32_t>(from[i]);
  return std::bit_cast<float>(bits);
}

uint64_t claimed_facets(Bytes bytes) {
  return bytes.size() < kHeaderSize ? 0 : std::bit_cast<uint32_t>(load_float(bytes.data() + 80));
}

/// A polygon of `size` fresh corners, the last positions of the mesh.
Result<void> add_last(MeshBuilder& builder, size_t size) {
  std::vector<MeshBuilder::Corner> corners(size);
  const size_t first = builder.mesh.positions.size() - size;
  for (size_t i = 0; i < size; ++i) corners[i].position = static_cast<int64_t>(first + i);
  return builder.add_face(corners);
}

Result<void> read_binary(Bytes bytes, MeshBuilder& builder, Watch& watch) {
  const uint64_t facets = claimed_facets(bytes);
  builder.mesh.positions.reserve(3 * facets);
  for (uint64_t facet = 0; facet < facets; ++facet) {
    watch.step();
    const std::byte* at = bytes.data() + kHeaderSize + facet * kFacetSize + 12;
    for (int corner = 0; corner < 3; ++corner, at += 12) {
      builder.mesh.positions.push_back({load_float(at), load_float(at + 4), load_float(at + 8)});
    }
    if (const auto added = add_last(builder, 3); !added) return added;
  }
  return {};
}

/// Keywords count where a line starts, so a solid's name may be any.
Result<void> read_text(std::string_view text, MeshBuilder& builder, const std::string& path, Watch& watch) {
  Tokens tokens(text);
  const auto failed = [&](std::string_view what) {
    return Error{ErrorClass::mesh, fmt::format("{}:{}", path, tokens.line()),
                 fmt::format("{}; export the mesh again, as binary STL if it can be", what)};
  };
  size_t corners = 0;
  bool ended = false;
  do {
    watch.step();
    const std::string word = lower_case(tokens.next_in_line());
    if (word == "vertex") {
      Vec3d p;
      for (int axis = 0; axis < 3; ++axis) {
        const std::string_view token = tokens.next_in_line();
        const auto number = parse_number(token);
        if (!number) return failed(fmt::format("'{}' is not a coordinate", token.substr(0, 40)));
        p.set(axis, *number);
      }
      builder.mesh.positions.push_back(p);
      ++corners;
    } else if (word == "endloop") {
      if (const auto added = add_last(builder, corners); !added) return failed(added.error().what);
      corners = 0;
    } else if (corners > 0 && !word.empty()) {
      return failed(fmt::format("'{}' within a loop", word.substr(0, 40)));
    }
    if (!word.empty()) ended = word.starts_with("endsolid");
  } while (tokens.next_line());
  return ended ? Result<void>{} : failed("no endsolid: truncated");
}

void weld_corners(Mesh& mesh, Watch& watch) {
  const std::vector<uint32_t> first_of = weld(mesh.positions, watch);
  std::vector<uint32_t> index_of(first_of.size());
  uint32_t kept = 0;
  for (uint32_t i = 0; i < first_of.size(); ++i) {
    watch.step();
    index_of[i] = first_of[i] == i ? kept : index_of[first_of[i]];
    if (first_of[i] == i) mesh.positions[kept++] = mesh.positions[i];
  }
  mesh.positions.resize(kept);
  for (auto& triangle : mesh.triangles) {
    watch.step();
    for (uint32_t& corner : triangle) corner = index_of[corner];
  }
}

}  // namespace

Result<Mesh> read_stl(Bytes bytes, const std::string& path, const ReadOptions& options) {
  Watch watch(options.progress);
  const std::string_view text = text_of(bytes);
  const bool is_text = lower_case(text.substr(0, 5)) == "solid";
  const uint64_t binary_size = kHeaderSize + claimed_facets(bytes) * kFacetSize;
  MeshBuilder builder;
  if (bytes.size() == binary_size || (!is_text && bytes.size() > binary_size && bytes.size() >= kHeaderSize)) {
    if (const auto read = read_binary(bytes, builder, watch); !read)
      return Error{ErrorClass::mesh, path, read.error().what};
  } else if (is_text) {
    if (const auto read = read_text(text, builder, path, watch); !read) return read.error();
  } else {
    return Error{ErrorClass::mesh, path,
                 fmt::format("neither text nor binary STL of the size it claims ({} bytes, but the file has {}): "
                             "truncated or damaged, export it again",
                             binary_size, bytes.size())};
  }
  weld_corners(builder.mesh, watch);
  return std::move(builder).finish(path);
}

}  // namespace kd::mesh
