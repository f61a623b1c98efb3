// glTF 2.0: meshes of triangles with their normals and materials. Materials are metals and dielectrics there and
// Phong's here: the base colour is diffuse and ambient, what is reflected at normal incidence (4 % of a dielectric's
// light, a metal's base colour) is specular as far as the surface is smooth, and the exponent is that of Blinn and
// Phong's distribution which is as wide as GGX's (B. Karis, "Specular BRDF Reference", 2013). Textures are not read; a
// material whose emission has one is left dark, for such a factor is white and the texture nearly black.
#include <algorithm>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "mesh/file_names.h"
#include "mesh/formats.h"
#include "mesh/gltf_accessor.h"
#include "mesh/gltf_file.h"
#include "mesh/gltf_scene.h"
#include "mesh/mesh_builder.h"

namespace kd::mesh {
namespace {

constexpr double kDielectric = 0.04;  // reflectance at normal incidence
constexpr double kMostShininess = 1000;
/// Primitives may share their bytes, or have zeros for them, so that a small file can describe any number of triangles.
/// So many vertices and corners are read of any file, or if that is more, this many for each of its bytes.
constexpr uint64_t kFreeCorners = uint64_t{1} << 25;
constexpr uint64_t kCornersPerByte = 16;

/// What the factor is multiplied by, >= 0 (KHR_materials_emissive_strength).
double emissive_strength(const tinygltf::Material& source) {
  const auto extension = source.extensions.find("KHR_materials_emissive_strength");
  if (extension == source.extensions.end() || !extension->second.Has("emissiveStrength")) return 1;
  return std::max(0.0, extension->second.Get("emissiveStrength").GetNumberAsDouble());
}

Vec3f emission_of(const tinygltf::Material& source) {
  if (source.emissiveTexture.index >= 0 || source.emissiveFactor.size() != 3) return {0, 0, 0};
  const double strength = emissive_strength(source);
  const auto one = [&](double factor) {
    const double emitted = std::clamp(factor, 0.0, 1.0) * strength;
    return static_cast<float>(std::min<double>(emitted, std::numeric_limits<float>::max()));
  };
  return {one(source.emissiveFactor[0]), one(source.emissiveFactor[1]), one(source.emissiveFactor[2])};
}

Material material_of(const tinygltf::Material& source) {
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  const auto unit = [](double v) { return std::clamp(v, 0.0, 1.0); };
  const double metallic = unit(pbr.metallicFactor), roughness = unit(pbr.roughnessFactor);
  Material material;
  for (int k = 0; k < 3; ++k) {
    const double base = unit(pbr.baseColorFactor[static_cast<size_t>(k)]);
    const double reflected = kDielectric + (base - kDielectric) * metallic;
    material.diffuse.set(k, static_cast<float>(base));
    material.specular.set(k, static_cast<float>(reflected * (1 - roughness)));
  }
  material.ambient = material.diffuse;
  material.emission = emission_of(source);
  const double width = roughness * roughness;
  const double exponent = width > 0 ? 2 / (width * width) - 2 : kMostShininess;
  material.shininess = static_cast<float>(std::clamp(exponent, 1.0, kMostShininess));
  return material;
}

/// What is left out, counted over the file.
struct LeftOut {
  uint64_t lines_and_points = 0;
  uint64_t without_positions = 0;
  uint64_t odd_indices = 0;
  uint64_t morphed = 0;
  uint64_t empty_meshes = 0;

  void report(std::vector<std::string>& warnings) const {
    const auto say = [&](uint64_t count, const char* what) {
      if (count > 0) warnings.push_back(fmt::format("{} {}", count, what));
    };
    say(lines_and_points, "primitive(s) of points or lines left out");
    say(without_positions, "primitive(s) without positions left out");
    say(odd_indices, "index(es) left out that make no whole triangle");
    say(morphed, "primitive(s) with morph targets stand as they were modelled");
    say(empty_meshes, "mesh(es) without triangles left out");
  }
};

class MeshReader {
 public:
  MeshReader(const GltfFile& file, const std::string& path, Watch& watch)
      : file_(file), path_(path), watch_(watch), corners_left_(std::max(kFreeCorners, file.size * kCornersPerByte)) {}

  LeftOut left_out;

  /// Empty if the mesh has no triangle.
  Result<Mesh> read(const tinygltf::Mesh& source);

 private:
  Result<void> read_primitive(const tinygltf::Primitive& source);
  Result<void> add_triangle(const std::array<uint64_t, 3>& numbers, uint16_t material);
  Result<uint16_t> find_material(int number);
  /// The mesh's number of a vertex of the primitive, which is added if it is new.
  uint32_t vertex(uint64_t number);

  Error failed(const std::string& what) const { return {ErrorClass::mesh, path_, what + "; export the mesh again"}; }

  const GltfFile& file_;
  const std::string& path_;
  Watch& watch_;
  uint64_t corners_left_;

  MeshBuilder builder_;  // of the current mesh, as what follows
  std::map<int, uint16_t> material_index_;
  std::vector<uint32_t> normal_of_;  // per position

  std::optional<GltfAccessor> positions_, normals_, indices_;  // of the current primitive
  std::map<int, std::vector<uint32_t>> vertices_of_;  // per accessor of positions: the mesh's numbers, kNoIndex between
  std::vector<uint32_t>* vertices_ = nullptr;         // of the current primitive's
  std::vector<uint64_t> used_;                        // entries there that are not kNoIndex
};

uint32_t MeshReader::vertex(uint64_t number) {
  uint32_t& index = (*vertices_)[number];
  if (index == kNoIndex) {
    index = static_cast<uint32_t>(builder_.mesh.positions.size());
    builder_.mesh.positions.push_back(positions_->vector(number));
    normal_of_.push_back(normals_ ? add_normal(builder_.mesh, normals_->vector(number)) : kNoIndex);
    used_.push_back(number);
  }
  return index;
}

Result<uint16_t> MeshReader::find_material(int number) {
  const auto& materials = file_.model.materials;
  if (number >= 0 && static_cast<size_t>(number) >= materials.size()) {
    return failed(fmt::format("a primitive has material {}, but there are {}", number, materials.size()));
  }
  Mesh& mesh = builder_.mesh;
  const auto [entry, fresh] = material_index_.try_emplace(number, static_cast<uint16_t>(mesh.materials.size()));
  if (!fresh) return entry->second;
  if (mesh.materials.size() >= std::numeric_limits<uint16_t>::max()) {
    return failed(fmt::format("a mesh has more than {} materials", std::numeric_limits<uint16_t>::max()));
  }
  if (number < 0) {
    mesh.materials.emplace_back();
    mesh.material_names.emplace_back("default");
  } else {
    const tinygltf::Material& source = materials[static_cast<size_t>(number)];
    mesh.materials.push_back(material_of(source));
    mesh.material_names.push_back(source.name.empty() ? fmt::format("material_{}", number) : source.name);
  }
  return entry->second;
}

Result<void> MeshReader::add_triangle(const std::array<uint64_t, 3>& numbers, uint16_t material) {
  std::array<MeshBuilder::Corner, 3> corners;
  for (size_t k = 0; k < 3; ++k) {
    const uint64_t number = indices_ ? indices_->index(numbers[k]) : numbers[k];
    if (number >= positions_->count()) {
      return failed(fmt::format("a primitive uses vertex {} (from 0), but has {}", number, positions_->count()));
    }
    const uint32_t v = vertex(number);
    corners[k] = {v, normal_of_[v]};
  }
  const auto added = builder_.add_face(corners, material);
  if (!added) return Error{added.error().error_class, path_, added.error().what};
  return {};
}

Result<void> MeshReader::read_primitive(const tinygltf::Primitive& source) {
  const bool is_strip = source.mode == TINYGLTF_MODE_TRIANGLE_STRIP, is_fan = source.mode == TINYGLTF_MODE_TRIANGLE_FAN;
  if (!is_strip && !is_fan && source.mode != TINYGLTF_MODE_TRIANGLES) {
    ++left_out.lines_and_points;
    return {};
  }
  const auto position = source.attributes.find("POSITION"), normal = source.attributes.find("NORMAL");
  if (position == source.attributes.end()) {
    ++left_out.without_positions;
    return {};
  }
  left_out.morphed += !source.targets.empty();
  const auto open = [&](auto reader, int number, std::optional<GltfAccessor>& accessor) -> Result<void> {
    Result<GltfAccessor> opened = reader(file_, number, path_);
    if (!opened) return opened.error();
    accessor = *opened;
    return {};
  };
  normals_.reset();
  indices_.reset();
  if (auto r = open(GltfAccessor::vectors, position->second, positions_); !r) return r;
  if (normal != source.attributes.end()) {
    if (auto r = open(GltfAccessor::vectors, normal->second, normals_); !r) return r;
    if (normals_->count() != positions_->count()) {
      return failed(
          fmt::format("a primitive has {} positions, but {} normals", positions_->count(), normals_->count()));
    }
  }
  if (source.indices >= 0) {
    if (auto r = open(GltfAccessor::indices, source.indices, indices_); !r) return r;
  }
  const Result<uint16_t> material = find_material(source.material);
  if (!material) return material.error();

  const uint64_t count = indices_ ? indices_->count() : positions_->count();
  const uint64_t triangles = is_strip || is_fan ? (count < 3 ? 0 : count - 2) : count / 3;
  left_out.odd_indices += is_strip || is_fan ? (triangles == 0 ? count : 0) : count % 3;
  vertices_ = &vertices_of_[position->second];
  const uint64_t new_vertices = positions_->count() - vertices_->size();
  if (triangles > corners_left_ / 3 || new_vertices > corners_left_ - 3 * triangles) {
    return failed(fmt::format("more than {} vertices and corners of triangles in {} bytes: primitives share too much",
                              std::max(kFreeCorners, file_.size * kCornersPerByte), file_.size));
  }
  corners_left_ -= 3 * triangles + new_vertices;

  vertices_->resize(positions_->count(), kNoIndex);
  for (uint64_t i = 0; i < triangles; ++i) {
    watch_.step();
    const uint64_t odd = i & 1;
    const auto added = is_fan     ? add_triangle({i + 1, i + 2, 0}, *material)
                       : is_strip ? add_triangle({i, i + 1 + odd, i + 2 - odd}, *material)
                                  : add_triangle({3 * i, 3 * i + 1, 3 * i + 2}, *material);
    if (!added) return added;
  }
  for (const uint64_t number : used_) (*vertices_)[number] = kNoIndex;
  used_.clear();
  return {};
}

Result<Mesh> MeshReader::read(const tinygltf::Mesh& source) {
  builder_ = {};
  material_index_.clear();
  normal_of_.clear();
  for (const tinygltf::Primitive& primitive : source.primitives) {
    if (const auto read = read_primitive(primitive); !read) return read.error();
  }
  Mesh& mesh = builder_.mesh;
  if (mesh.triangles.empty()) {
    ++left_out.empty_meshes;
    return Mesh{};
  }
  const bool names_none = material_index_.size() == 1 && material_index_.begin()->first < 0;
  if (names_none) {
    mesh.materials.clear();
    mesh.material_names.clear();
  }
  return std::move(builder_).finish(path_);
}

}  // namespace

Result<Asset> read_gltf(Bytes bytes, const std::string& path, const ReadOptions& options) {
  Watch watch(options.progress);
  const Result<GltfFile> file = open_gltf(bytes, path, watch);
  if (!file) return file.error();
  Asset asset;
  asset.warnings = file->warnings;
  MeshReader reader(*file, path, watch);
  FileNames names;
  std::vector<uint32_t> mesh_of;
  for (const tinygltf::Mesh& source : file->model.meshes) {
    Result<Mesh> mesh = reader.read(source);
    if (!mesh) return mesh.error();
    const bool is_empty = mesh->triangles.empty();
    mesh_of.push_back(is_empty ? kNoIndex : static_cast<uint32_t>(asset.meshes.size()));
    if (is_empty) continue;
    const auto whole = static_cast<uint32_t>(asset.meshes.size());
    const std::string wish = source.name.empty() ? fmt::format("mesh_{}", mesh_of.size() - 1) : source.name;
    asset.meshes.push_back({names.give(wish), std::move(*mesh), whole});
  }
  reader.left_out.report(asset.warnings);
  if (asset.meshes.empty()) return Error{ErrorClass::mesh, path, "no faces: the file holds no surface to compile"};
  if (const auto placed = place_nodes(*file, path, mesh_of, asset); !placed) return placed.error();
  return asset;
}

}  // namespace kd::mesh
