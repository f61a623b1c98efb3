#include "mesh/asset.h"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "mesh/file_names.h"
#include "mesh/formats.h"
#include "mesh/split.h"

namespace kd::mesh {
namespace {

/// One mesh that stands where it was made.
Asset asset_of(Mesh mesh, const std::string& name) {
  Asset asset;
  asset.meshes.push_back({name, std::move(mesh)});
  asset.instances.push_back({name, 0, {}});
  return asset;
}

/// The mesh as its parts; empty if it would be one, which is then the mesh itself.
std::vector<MeshPart> parts_of(const Mesh& mesh, Split split) {
  std::vector<MeshPart> parts;
  if (split == Split::object && !mesh.group_ids.empty()) parts = split_by_group(mesh);
  if (split == Split::material && !mesh.material_ids.empty()) parts = split_by_material(mesh);
  if (parts.size() < 2) parts.clear();
  return parts;
}

/// Replaces each mesh by its parts and each instance by one of every part. A part of the only mesh is named after what
/// it was split by alone.
void split_meshes(Asset& asset, Split split) {
  std::vector<NamedMesh> wholes = std::move(asset.meshes);
  asset.meshes.clear();
  FileNames names;
  std::vector<uint32_t> first;  // per whole mesh: its first part
  for (uint32_t i = 0; i < wholes.size(); ++i) {
    NamedMesh& whole = wholes[i];
    first.push_back(static_cast<uint32_t>(asset.meshes.size()));
    std::vector<MeshPart> parts = parts_of(whole.mesh, split);
    if (parts.empty()) {
      asset.meshes.push_back({names.give(whole.name), std::move(whole.mesh), i});
      continue;
    }
    for (std::string& warning : whole.mesh.warnings) asset.warnings.push_back(std::move(warning));
    for (MeshPart& part : parts) {
      const std::string wish = wholes.size() == 1 ? part.name : fmt::format("{}_{}", whole.name, part.name);
      asset.meshes.push_back({names.give(wish), std::move(part.mesh), i});
    }
    whole.mesh = {};
  }
  first.push_back(static_cast<uint32_t>(asset.meshes.size()));

  const std::vector<MeshInstance> instances = std::exchange(asset.instances, {});
  for (const MeshInstance& instance : instances) {
    const bool is_split = first[instance.mesh + 1] - first[instance.mesh] > 1;
    for (uint32_t part = first[instance.mesh]; part < first[instance.mesh + 1]; ++part) {
      const std::string& name = wholes.size() == 1 && is_split ? asset.meshes[part].name : instance.name;
      asset.instances.push_back({name, part, instance.frame});
    }
  }
}

}  // namespace

bool Asset::is_plain_mesh() const {
  if (meshes.size() != 1 || instances.size() != 1 || camera || !lights.empty()) return false;
  const Frame &frame = instances[0].frame, identity;
  return frame.point == identity.point && frame.x_axis == identity.x_axis && frame.y_axis == identity.y_axis &&
         frame.z_axis == identity.z_axis;
}

Result<Asset> read_asset(const std::string& path, const ReadOptions& options, Split split) {
  return read_file<Asset>(path, [&](Bytes bytes, const Format& format) -> Result<Asset> {
    Asset asset;
    if (format.read_asset) {
      Result<Asset> read = format.read_asset(bytes, path, options);
      if (!read) return read.error();
      asset = std::move(*read);
    } else {
      Result<Mesh> read = format.read_mesh(bytes, path, options);
      if (!read) return read.error();
      asset = asset_of(std::move(*read), FileNames().give(std::filesystem::path(path).stem().string()));
    }
    const size_t wholes = asset.meshes.size();
    // The meshes of a format that names several are its objects.
    if (split == Split::material || (split == Split::object && format.read_mesh)) {
      split_meshes(asset, split);
      if (asset.meshes.size() == wholes) {
        asset.warnings.push_back(fmt::format("not split: no mesh has more than one {}",
                                             split == Split::object ? "group or object" : "material"));
      }
    }
    return asset;
  });
}

}  // namespace kd::mesh
