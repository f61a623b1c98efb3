// OBJ: faces, groups and materials through tinyobjloader's callbacks, which give the faces in file order and unaltered
// (its other interface leaves out faces with bad indices and may lose corners of polygons). The v and vn lines are read
// here: tinyobjloader takes what is no number, "nan" included, for 0, and rounds decimals up to a few ulps off.
#include <algorithm>
#include <limits>
#include <set>
#include <sstream>
#include <unordered_map>

#include <fmt/format.h>

#include "mesh/dependencies.h"
#include "mesh/formats.h"
#include "mesh/mesh_builder.h"
#include "mesh/obj_lines.h"
#include "mesh/read_mtl.h"
#include "mesh/text.h"

namespace kd::mesh {
namespace {

/// Positions and normals in file order, as tinyobjloader counts them.
struct Vertices {
  std::vector<Vec3d> positions;
  std::vector<Vec3d> normals;
};

/// Whether a run of digits is longer than any index; tinyobjloader would take it modulo 2^32.
bool has_long_index(std::string_view corner) {
  size_t digits = 0;
  for (const char c : corner) {
    digits = c >= '0' && c <= '9' ? digits + 1 : 0;
    if (digits > 9) return true;
  }
  return false;
}

/// Also looks at the f lines, for indices that tinyobjloader cannot hold.
Result<Vertices> read_vertices(std::string_view text, const std::string& path, Watch& watch) {
  Vertices vertices;
  Tokens tokens(text);
  const auto failed = [&](const std::string& what) {
    return Error{ErrorClass::mesh, fmt::format("{}:{}", path, tokens.line()), what + "; export the mesh again"};
  };
  do {
    watch.step();
    const std::string_view keyword = tokens.next_in_line();
    if (keyword == "f") {
      for (std::string_view corner = tokens.next_in_line(); !corner.empty(); corner = tokens.next_in_line()) {
        if (has_long_index(corner)) return failed(fmt::format("'{}' is out of range", corner.substr(0, 40)));
      }
    }
    if (keyword != "v" && keyword != "vn") continue;
    Vec3d p;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view token = tokens.next_in_line();
      const auto number = parse_number(token);
      if (!number) {
        return failed(token.empty() ? fmt::format("'{}' needs three numbers", keyword)
                                    : fmt::format("'{}' is not a number", token.substr(0, 40)));
      }
      p.set(axis, *number);
    }
    (keyword == "v" ? vertices.positions : vertices.normals).push_back(p);
  } while (tokens.next_line());
  return vertices;
}

/// The line of the `count`-th face, from 0.
uint64_t face_line(std::string_view text, uint64_t count) {
  Tokens tokens(text);
  do {
    if (tokens.next_in_line() == "f" && !tokens.next_in_line().empty() && count-- == 0) return tokens.line();
  } while (tokens.next_line());
  return tokens.line();
}

/// What tinyobjloader's callbacks fill.
struct Reading {
  Reading(MtlReader reader, Watch& w) : watch(w), materials(std::move(reader)) { enter_group(""); }

  /// Groups and objects of one name are one; those without a name, and what stands before any, are "default".
  void enter_group(const std::string& name) {
    std::vector<std::string>& names = builder.mesh.group_names;
    const auto [entry, fresh] =
        group_of.try_emplace(name.empty() ? "default" : name, static_cast<uint32_t>(names.size()));
    if (fresh) names.push_back(entry->first);
    group = entry->second;
  }

  Watch& watch;
  MeshBuilder builder;
  std::vector<uint32_t> normal_of;  // per vn line: the index in the mesh's normals
  MtlReader materials;
  uint64_t faces = 0;  // lines seen so far, for indices that count back from here
  int64_t positions = 0;
  int64_t normals = 0;
  int material = -1;
  uint32_t group = 0;
  std::unordered_map<std::string, uint32_t> group_of;
  std::set<std::string> undefined;  // names of materials
  bool uses_default = false;
  std::string fault;  // of face `faces`; the rest is not read
  std::vector<MeshBuilder::Corner> corners;
};

constexpr uint16_t kDefaultMaterial = std::numeric_limits<uint16_t>::max();

/// An OBJ index, from 1 or counting back from the last, as one from 0; -1 or less, or too large, if out of range.
int64_t from_zero(int index, int64_t count) { return index > 0 ? int64_t{index} - 1 : count + index; }

void take_face(void* user, tinyobj::index_t* indices, int count) {
  Reading& r = *static_cast<Reading*>(user);
  r.watch.step();
  if (!r.fault.empty()) return;
  r.corners.clear();
  for (const tinyobj::index_t& index : std::span(indices, static_cast<size_t>(count))) {
    MeshBuilder::Corner corner;
    const auto all = static_cast<int64_t>(r.builder.mesh.positions.size());
    corner.position = from_zero(index.vertex_index, r.positions);
    if (index.vertex_index == 0 || corner.position < 0 || corner.position >= all) {
      r.fault = fmt::format("face {} (from 0) uses vertex {}, but the file has {}; export the mesh again", r.faces,
                            index.vertex_index, all);
      return;
    }
    if (index.normal_index != 0) {
      const int64_t normal = from_zero(index.normal_index, r.normals);
      if (normal < 0 || normal >= static_cast<int64_t>(r.normal_of.size())) {
        r.fault = fmt::format("face {} (from 0) uses normal {}, but the file has {}; export the mesh again", r.faces,
                              index.normal_index, r.normal_of.size());
        return;
      }
      corner.normal = r.normal_of[static_cast<size_t>(normal)];
    }
    r.corners.push_back(corner);
  }
  const bool is_default = r.material < 0;
  r.uses_default |= is_default;
  const auto added = r.builder.add_face(r.corners, is_default ? kDefaultMaterial : static_cast<uint16_t>(r.material));
  if (!added) r.fault = added.error().what;
  r.builder.mesh.group_ids.resize(r.builder.mesh.triangles.size(), r.group);
  ++r.faces;
}

void take_group(void* user, const char** names, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += fmt::format("{}{}", i > 0 ? " " : "", names[i]);
  static_cast<Reading*>(user)->enter_group(all);
}

void take_object(void* user, const char* name) {
  std::string_view text = name;
  while (text.ends_with(' ') || text.ends_with('\t')) text.remove_suffix(1);
  static_cast<Reading*>(user)->enter_group(std::string(text));
}

void take_material(void* user, const char* name, int) {
  Reading& r = *static_cast<Reading*>(user);
  r.material = r.materials.find(name);
  if (r.material < 0) r.undefined.insert(name);
}

/// Moves the materials into the mesh, with the default one behind them if some face needs it.
Result<void> place_materials(Reading& r, const std::string& path) {
  Mesh& mesh = r.builder.mesh;
  mesh.materials = std::move(r.materials.materials);
  mesh.material_names = std::move(r.materials.names);
  mesh.warnings = std::move(r.materials.warnings);
  if (mesh.materials.size() >= kDefaultMaterial) {
    return Error{ErrorClass::mesh, path,
                 fmt::format("{} materials, but at most {} can be kept; merge some", mesh.materials.size(),
                             kDefaultMaterial - 1)};
  }
  if (!r.undefined.empty()) {
    mesh.warnings.push_back(
        fmt::format("{} material(s) not defined in any MTL file ('{}' and so on); their faces get the "
                    "default material",
                    r.undefined.size(), r.undefined.begin()->substr(0, 40)));
  }
  const bool names_none = mesh.materials.empty() && mesh.warnings.empty();
  if (names_none || !r.uses_default) return {};
  const auto index = static_cast<uint16_t>(mesh.materials.size());
  std::replace(mesh.material_ids.begin(), mesh.material_ids.end(), kDefaultMaterial, index);
  mesh.materials.emplace_back();
  mesh.material_names.emplace_back("default");
  return {};
}

}  // namespace

Result<Mesh> read_obj(Bytes bytes, const std::string& path, const ReadOptions& options) {
  Watch watch(options.progress);
  std::istringstream in(plain_obj_lines(text_of(bytes), watch));
  const std::string_view text = in.view();
  Result<Vertices> vertices = read_vertices(text, path, watch);
  if (!vertices) return vertices.error();

  Reading reading(MtlReader(path, options.ambient_from_diffuse), watch);
  reading.builder.mesh.positions = std::move(vertices->positions);
  for (const Vec3d& normal : vertices->normals) {
    watch.step();
    reading.normal_of.push_back(add_normal(reading.builder.mesh, normal));
  }
  tinyobj::callback_t callbacks;
  using Real = tinyobj::real_t;
  callbacks.vertex_cb = [](void* user, Real, Real, Real, Real) {
    ++static_cast<Reading*>(user)->positions;
    static_cast<Reading*>(user)->watch.step();
  };
  callbacks.normal_cb = [](void* user, Real, Real, Real) {
    ++static_cast<Reading*>(user)->normals;
    static_cast<Reading*>(user)->watch.step();
  };
  callbacks.texcoord_cb = [](void* user, Real, Real, Real) { static_cast<Reading*>(user)->watch.step(); };
  callbacks.index_cb = take_face;
  callbacks.usemtl_cb = take_material;
  callbacks.group_cb = take_group;
  callbacks.object_cb = take_object;
  std::string warning, error;
  const bool parsed = tinyobj::LoadObjWithCallback(in, callbacks, &reading, &reading.materials, &warning, &error);
  if (!reading.fault.empty()) {
    return Error{ErrorClass::mesh, fmt::format("{}:{}", path, face_line(text, reading.faces)), reading.fault};
  }
  if (!parsed) return Error{ErrorClass::mesh, path, fmt::format("tinyobjloader: {}", error)};
  if (const auto placed = place_materials(reading, path); !placed) return placed.error();
  if (reading.builder.mesh.group_names.size() == 1) {
    reading.builder.mesh.group_names.clear();
    reading.builder.mesh.group_ids.clear();
  }
  reading.builder.mesh.dependencies = mtl_files(text, path, watch);
  return std::move(reading.builder).finish(path);
}

}  // namespace kd::mesh
