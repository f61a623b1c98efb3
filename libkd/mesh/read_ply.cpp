// PLY through OpenMesh's reader, into plain arrays: its halfedge meshes refuse non-manifold faces, its import interface
// does not. What that reader would get wrong without a word is settled before it starts: it is given a header of our
// own, in which only what is wanted has a name, and a stream that throws at the first value it cannot read.
#include <algorithm>
#include <mutex>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <OpenMesh/Core/IO/reader/PLYReader.hh>
#include <OpenMesh/Core/System/omstream.hh>

#include "mesh/formats.h"
#include "mesh/mesh_builder.h"
#include "mesh/openmesh_importer.h"
#include "mesh/ply_exact.h"
#include "mesh/ply_header.h"
#include "mesh/text.h"

namespace kd::mesh {
namespace {

/// OpenMesh logs to std::cerr; libkd prints nothing. Its readers and its log are singletons, hence the lock.
class QuietOpenMesh {
 public:
  QuietOpenMesh() : lock_(mutex()), was_enabled_(omerr().is_enabled()) { omerr().disable(); }
  ~QuietOpenMesh() {
    if (was_enabled_) omerr().enable();
  }
  QuietOpenMesh(const QuietOpenMesh&) = delete;
  QuietOpenMesh& operator=(const QuietOpenMesh&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }
  std::lock_guard<std::mutex> lock_;
  bool was_enabled_;
};

bool is_coordinate(const std::string& name) { return name == "x" || name == "y" || name == "z"; }
bool is_normal(const std::string& name) { return name == "nx" || name == "ny" || name == "nz"; }
bool is_face_list(const std::string& name) { return name == "vertex_indices" || name == "vertex_index"; }

/// What OpenMesh cannot read, or would misread, as a message; empty if all is well.
std::string find_fault(const PlyHeader& header) {
  const auto *vertex = header.find("vertex"), *face = header.find("face");
  if (!vertex || !face) return "no element 'vertex' or no element 'face'; only meshes with faces can be compiled";
  int coordinates = 0;
  for (const auto& element : header.elements) {
    for (const auto& property : element.properties) {
      const bool wanted = &element == face && is_face_list(property.name);
      if (wanted && (property.count_type.empty() || property.type.starts_with("float"))) {
        return fmt::format("'{}' is not a list of whole numbers", property.name);
      }
      if (!wanted && !property.count_type.empty()) {
        return fmt::format("the list '{}' of element '{}' is not read; export the mesh without it", property.name,
                           element.name);
      }
      if (&element == vertex && (is_coordinate(property.name) || is_normal(property.name))) {
        if (!property.type.starts_with("float")) return fmt::format("'{}' is not of a float type", property.name);
        coordinates += is_coordinate(property.name);
      }
    }
    if (&element == face) break;
  }
  if (coordinates != 3) return "the vertices, which must come before the faces, have no x, y and z, one each";
  if (face->properties.empty() || !is_face_list(face->properties[0].name)) {
    return "the faces do not begin with vertex_indices; export the mesh without other face properties";
  }
  return "";
}

/// The header OpenMesh is given. It knows four count types by other names than ours, and skips, by their size, single
/// values whose names it does not know.
std::string plain_header(const PlyHeader& header) {
  const auto count_type = [](const std::string& type) {
    return ply_type_size(type) == 1 ? "uint8" : ply_type_size(type) == 2 ? "uint16" : "int";
  };
  std::string text = fmt::format("ply\nformat {} 1.0\n", header.format);
  for (const auto& element : header.elements) {
    text += fmt::format("element {} {}\n", element.name, element.count);
    int skipped = 0;
    for (const auto& p : element.properties) {
      const bool wanted = element.name == "vertex" && (is_coordinate(p.name) || is_normal(p.name));
      if (!p.count_type.empty()) {
        text += fmt::format("property list {} {} vertex_indices\n", count_type(p.count_type), p.type);
      } else {
        text += fmt::format("property {} {}\n", p.type, wanted ? p.name : fmt::format("skipped_{}", skipped++));
      }
    }
    if (element.name == "face") break;
  }
  return text + "end_header\n";
}

/// Runs OpenMesh over `data`, what follows the header.
Result<void> run_openmesh(const PlyHeader& header, std::string_view data, const std::string& path,
                          OpenMeshImporter& importer, Watch& watch) {
  std::string text = plain_header(header);
  const size_t header_size = text.size();
  text.reserve(header_size + data.size() + 1);
  constexpr size_t kPiece = size_t{1} << 24;
  for (size_t at = 0; at < data.size(); at += kPiece) {
    text += data.substr(at, kPiece);
    watch.look();
  }
  if (header.is_text()) text += '\n';  // the end of the file is then never the end of a number
  std::istringstream in(std::move(text), std::ios::in | std::ios::binary);
  bool complete = false;
  try {
    const QuietOpenMesh quiet;
    in.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
    OpenMesh::IO::Options options(OpenMesh::IO::Options::VertexNormal);
    complete = OpenMesh::IO::PLYReader().read(in, importer, options);
  } catch (const std::ios_base::failure&) {
    complete = false;
  }
  if (complete) return {};
  in.exceptions(std::ios::goodbit);
  in.clear();
  const size_t at = std::max(static_cast<size_t>(in.tellg()), header_size) - header_size;
  const auto read = data.substr(0, at);
  const std::string place =
      header.is_text()
          ? fmt::format("{}:{}", path,
                        header.lines + 1 + static_cast<uint64_t>(std::count(read.begin(), read.end(), '\n')))
          : path;
  return Error{
      ErrorClass::mesh, place,
      fmt::format("cannot be read beyond vertex {} of {} and face {} of {}: truncated or damaged, export it again",
                  importer.positions.size(), header.find("vertex")->count, importer.n_faces(),
                  header.find("face")->count)};
}

}  // namespace

Result<Mesh> read_ply(Bytes bytes, const std::string& path, const ReadOptions& options) {
  Watch watch(options.progress);
  const std::string_view text = text_of(bytes);
  const Result<PlyHeader> header = read_ply_header(text, path);
  if (!header) return header.error();
  if (const std::string fault = find_fault(*header); !fault.empty()) return Error{ErrorClass::mesh, path, fault};
  const std::string_view data = text.substr(header->size);

  OpenMeshImporter importer(watch);
  if (const auto done = run_openmesh(*header, data, path, importer, watch); !done) return done.error();
  MeshBuilder builder;
  builder.mesh.positions = std::move(importer.positions);
  restore_doubles(*header, data, builder.mesh.positions, watch);

  std::vector<uint32_t> normal_of(importer.normals.size());
  for (size_t i = 0; i < normal_of.size(); ++i) {
    watch.step();
    normal_of[i] = add_normal(builder.mesh, importer.normals[i]);
  }
  std::vector<MeshBuilder::Corner> corners;
  size_t first = 0;
  for (const size_t end : importer.face_ends) {
    watch.step();
    corners.clear();
    for (; first < end; ++first) {
      const auto position = importer.corners[first];
      const bool has_normal = position >= 0 && static_cast<size_t>(position) < normal_of.size();
      corners.push_back({position, has_normal ? normal_of[static_cast<size_t>(position)] : kNoIndex});
    }
    if (const auto added = builder.add_face(corners); !added) {
      return Error{added.error().error_class, path, added.error().what};
    }
  }
  return std::move(builder).finish(path);
}

}  // namespace kd::mesh
