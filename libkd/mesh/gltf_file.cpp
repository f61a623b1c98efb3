// tinygltf 2.7 is not made for files from anywhere. It descends as deep as the JSON does, reads 8 bytes beyond a short
// GLB chunk, forms pointers outside buffers for images, takes whole numbers modulo 2^32, ignores values of a wrong
// type, drops primitives that it cannot read, and looks for files in the working directory. So it is given JSON alone,
// in which depth and types are checked and from which all that is not used is gone; the container and the buffers are
// read here.
#define TINYGLTF_IMPLEMENTATION
#include "mesh/gltf_file.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mesh/data_uri.h"
#include "mesh/gltf_json.h"
#include "mesh/text.h"

namespace kd::mesh {
namespace {

using Json = nlohmann::json;

/// Members of the root that are not used though they are meant to be seen.
struct LeftOut {
  const char* name;
  const char* warning;
};
constexpr std::array kLeftOut{
    LeftOut{"textures", "textures are left out: colours are the materials' factors"},
    LeftOut{"skins", "skins are left out: meshes stand as they were modelled"},
    LeftOut{"animations", "animations are left out"},
};

/// What kind of file this is comes before what is wrong with it.
std::string find_version_fault(const Json& root) {
  const auto asset = root.find("asset");
  if (asset == root.end() || !asset->is_object() || !asset->contains("version") || !asset->at("version").is_string()) {
    return "no 'asset.version': this is no glTF 2.0 file";
  }
  const std::string version = asset->at("version");
  if (!version.starts_with("2.")) return fmt::format("glTF version {}: only 2.x is read", version.substr(0, 20));
  return "";
}

bool is_known(const std::string& extension) {
  // Materials' and textures' extensions change colours only.
  return extension == "KHR_mesh_quantization" || extension == "KHR_lights_punctual" ||
         extension.starts_with("KHR_technique") || extension.starts_with("KHR_materials_") ||
         extension.find("_texture_") != std::string::npos;
}

/// A member, or null.
const Json& member(const Json& object, const char* name) {
  static const Json none;
  const auto found = object.find(name);
  return found == object.end() ? none : *found;
}

/// Extensions that change where geometry is, or what is known of it.
std::string find_extension_fault(const Json& root) {
  for (const Json& extension : member(root, "extensionsRequired")) {
    const std::string& name = extension.get_ref<const std::string&>();
    if (!is_known(name)) return fmt::format("the required extension '{}' is not read", name.substr(0, 60));
  }
  // Not every exporter says that Draco's compression is required where nothing else is there.
  const Json& accessors = member(root, "accessors");
  for (const Json& mesh : member(root, "meshes")) {
    for (const Json& primitive : member(mesh, "primitives")) {
      const Json& position = member(member(primitive, "attributes"), "POSITION");
      if (member(primitive, "extensions").empty() || position.is_null() || position >= accessors.size()) continue;
      if (member(accessors[position.get<size_t>()], "bufferView").is_null())
        return "the extension 'KHR_draco_mesh_compression' is not read, and a primitive has its positions in it alone";
    }
  }
  return "";
}

/// A buffer's URI as a path relative to the glTF file's folder, or nothing if it leads elsewhere.
std::optional<std::filesystem::path> relative_file(const std::string& uri) {
  const std::string decoded = decoded_uri(uri);
  const std::filesystem::path file(decoded);
  const bool is_plain = decoded.find_first_of(std::string_view(":\\\0", 3)) == std::string::npos;
  if (!is_plain || file.empty() || file.is_absolute()) return std::nullopt;
  if (std::find(file.begin(), file.end(), "..") != file.end()) return std::nullopt;
  return file;
}

/// All bytes of a buffer, which may be more than it says it has.
Result<Bytes> find_bytes(const Json& buffer, size_t index, const GltfContainer& container, const std::string& path,
                         GltfFile& file, Watch& watch) {
  const auto uri = buffer.find("uri");
  if (uri == buffer.end()) {
    if (index == 0 && container.binary) return *container.binary;
    return gltf_error(path, fmt::format("buffer {} has no 'uri', and the file no binary chunk for it", index));
  }
  const std::string& text = uri->get_ref<const std::string&>();
  if (text.starts_with("data:")) {
    auto bytes = decode_data_uri(text, watch);
    if (!bytes) return gltf_error(path, fmt::format("the data: URI of buffer {} is empty or not in base64", index));
    return Bytes(file.decoded.emplace_back(std::move(*bytes)));
  }
  const auto name = relative_file(text);
  if (!name) {
    return gltf_error(path,
                      fmt::format("buffer {} is in {}, but buffers are only read from files beside this one", index,
                                  Json(text.substr(0, 80)).dump(-1, ' ', true, Json::error_handler_t::replace)));
  }
  if (const auto known = file.mapped.find(*name); known != file.mapped.end()) return known->second.bytes();
  Result<MappedFile> mapped = MappedFile::open((std::filesystem::path(path).parent_path() / *name).string());
  if (!mapped) return mapped.error();
  file.size += mapped->bytes().size();
  return file.mapped.emplace(*name, std::move(*mapped)).first->second.bytes();
}

Result<void> open_buffers(const Json& root, const GltfContainer& container, const std::string& path, GltfFile& file,
                          Watch& watch) {
  const auto buffers = root.find("buffers");
  if (buffers == root.end()) return {};
  for (const Json& buffer : *buffers) {
    const size_t index = file.buffers.size();
    if (!buffer.contains("byteLength")) return gltf_error(path, fmt::format("buffer {} has no 'byteLength'", index));
    const Result<Bytes> bytes = find_bytes(buffer, index, container, path, file, watch);
    if (!bytes) return bytes.error();
    const uint64_t length = buffer.at("byteLength");
    if (length > bytes->size()) {
      return gltf_error(path, fmt::format("buffer {} has {} of its {} bytes: truncated", index, bytes->size(), length));
    }
    file.buffers.push_back(bytes->first(length));
  }
  return {};
}

}  // namespace

Result<GltfFile> open_gltf(Bytes bytes, const std::string& path, Watch& watch) {
  const Result<GltfContainer> container = open_container(bytes, path);
  if (!container) return container.error();
  Result<Json> root = parse_gltf_json(text_of(container->json), path, watch);
  if (!root) return root.error();
  if (const std::string fault = find_version_fault(*root); !fault.empty()) return gltf_error(path, fault);

  GltfFile file;
  file.size = bytes.size();
  for (const LeftOut& left_out : kLeftOut) {
    const auto found = root->find(left_out.name);
    if (found != root->end() && !found->empty()) file.warnings.emplace_back(left_out.warning);
  }
  if (const std::string fault = keep_what_is_read(*root); !fault.empty()) return gltf_error(path, fault);
  if (const std::string fault = find_extension_fault(*root); !fault.empty()) return gltf_error(path, fault);
  if (const auto opened = open_buffers(*root, *container, path, file, watch); !opened) return opened.error();
  root->erase("buffers");

  const std::string text = root->dump();
  root = Json();
  if (text.size() > std::numeric_limits<uint32_t>::max()) return gltf_error(path, "more than 4 GiB of JSON");
  std::string error, warning;
  const bool parsed = tinygltf::TinyGLTF().LoadASCIIFromString(&file.model, &error, &warning, text.c_str(),
                                                               static_cast<unsigned>(text.size()), "");
  // It says that a primitive is left out, and goes on.
  if (!parsed || !error.empty())
    return gltf_error(path, fmt::format("tinygltf: {}", error.substr(0, error.find('\n'))));
  return file;
}

}  // namespace kd::mesh
