// OFF in text, by hand: OpenMesh's reader narrows coordinates to float32, takes a comment for numbers, goes on past
// whatever it cannot read and prints to std::cerr. Normals, colours and texture coordinates are not kept.
#include <fmt/format.h>

#include "mesh/formats.h"
#include "mesh/mesh_builder.h"
#include "mesh/text.h"

namespace kd::mesh {
namespace {

/// Lines that hold something; a comment runs from # to the end of its line.
class OffLines {
 public:
  OffLines(std::string_view text, std::string path) : tokens_(text), path_(std::move(path)) {}

  /// The next token, on this line or on the next one that has any; empty at the end of the file.
  std::string_view next() {
    for (;;) {
      const std::string_view token = next_in_line();
      if (!token.empty() || !tokens_.next_line()) return token;
    }
  }
  std::string_view next_in_line() {
    if (ended_line_ == tokens_.line()) return {};
    const std::string_view token = tokens_.next_in_line();
    if (!token.starts_with('#')) return token;
    ended_line_ = tokens_.line();
    return {};
  }
  /// Leaves what is left of the line: colours and the like.
  void skip_rest() { tokens_.next_line(); }

  Error failed(std::string_view what) const {
    return {ErrorClass::mesh, fmt::format("{}:{}", path_, tokens_.line()),
            fmt::format("{}; not an OFF file, or a damaged one: export it again", what)};
  }

 private:
  Tokens tokens_;
  std::string path_;
  uint64_t ended_line_ = 0;
};

Result<void> read_vertices(OffLines& lines, uint64_t count, std::vector<Vec3d>& positions, Watch& watch) {
  positions.reserve(count);
  for (uint64_t i = 0; i < count; ++i) {
    watch.step();
    Vec3d p;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view token = axis == 0 ? lines.next() : lines.next_in_line();
      const auto number = parse_number(token);
      if (!number) return lines.failed(fmt::format("vertex {} has no number where '{}' is", i, token.substr(0, 40)));
      p.set(axis, *number);
    }
    lines.skip_rest();
    positions.push_back(p);
  }
  return {};
}

Result<void> read_faces(OffLines& lines, uint64_t count, MeshBuilder& builder, Watch& watch) {
  std::vector<MeshBuilder::Corner> corners;
  for (uint64_t i = 0; i < count; ++i) {
    watch.step();
    const auto size = parse_count(lines.next());
    if (!size) return lines.failed(fmt::format("face {} has no number of corners", i));
    corners.clear();
    for (uint64_t k = 0; k < *size; ++k) {
      const auto index = parse_count(lines.next_in_line());
      if (!index) return lines.failed(fmt::format("face {} has {} of {} vertex numbers", i, k, *size));
      corners.push_back({static_cast<int64_t>(*index), kNoIndex});
    }
    if (const auto added = builder.add_face(corners); !added) return lines.failed(added.error().what);
    lines.skip_rest();
  }
  return {};
}

}  // namespace

Result<Mesh> read_off(Bytes bytes, const std::string& path, const ReadOptions& options) {
  Watch watch(options.progress);
  OffLines lines(text_of(bytes), path);
  std::string_view keyword = lines.next();
  // [ST][C][N][4][n]OFF: what comes before OFF says what a vertex has besides; 4 and n change what its numbers mean.
  if (!keyword.ends_with("OFF") || keyword.find_first_of("4n") != std::string_view::npos) {
    return lines.failed(fmt::format("'{}' is not the keyword OFF of three dimensions", keyword.substr(0, 40)));
  }
  const std::string_view first = lines.next();
  if (first == "BINARY") return lines.failed("binary OFF is not read");
  const auto vertices = parse_count(first), faces = parse_count(lines.next()), edges = parse_count(lines.next());
  if (!vertices || !faces || !edges) return lines.failed("the numbers of vertices, faces and edges are not there");
  if (*vertices > bytes.size() || *faces > bytes.size()) {
    return lines.failed(fmt::format("{} vertices and {} faces cannot be in {} bytes", *vertices, *faces, bytes.size()));
  }
  lines.skip_rest();

  MeshBuilder builder;
  if (const auto read = read_vertices(lines, *vertices, builder.mesh.positions, watch); !read) return read.error();
  if (const auto read = read_faces(lines, *faces, builder, watch); !read) return read.error();
  return std::move(builder).finish(path);
}

}  // namespace kd::mesh
