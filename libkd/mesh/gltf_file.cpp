// tinygltf 2.7 is not made for files from anywhere. It descends as deep as the JSON does, reads 8 bytes beyond a short
// GLB chunk, forms pointers outside buffers for images, takes whole numbers modulo 2^32, ignores values of a wrong
// type, drops primitives that it cannot read, and looks for files in the working directory. So it is given JSON alone,
// in which depth and types are checked and from which all that is not used is gone; the container and the buffers are
// read here.
#define TINYGLTF_IMPLEMENTATION
#include "mesh/gltf_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mesh/text.h"

namespace kd::mesh {
namespace {

using Json = nlohmann::json;

constexpr int kMostNested = 64;  // arrays and objects around a value
constexpr uint64_t kMostIndex = std::numeric_limits<int32_t>::max();
constexpr uint64_t kMostBytes = uint64_t{1} << 53;

/// What is wrong may repeat names of the file: cut short, and made one line.
Error failed(const std::string& path, std::string what) {
  what.resize(std::min(what.size(), size_t{300}));
  for (char& c : what) {
    if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = ' ';
  }
  return {ErrorClass::mesh, path, what + "; export the mesh again"};
}

/// The JSON, and the bytes of the first buffer if it is in the same file.
struct Container {
  Bytes json;
  std::optional<Bytes> binary;
};

uint32_t word_at(Bytes bytes, size_t offset) {
  uint32_t word;
  std::memcpy(&word, bytes.data() + offset, sizeof word);
  return word;
}

Result<Container> open_container(Bytes bytes, const std::string& path) {
  constexpr uint32_t kMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
  if (bytes.size() < 4 || word_at(bytes, 0) != kMagic) return Container{bytes, {}};
  if (bytes.size() < 12) return failed(path, "a GLB header has 12 bytes, and the file fewer: it is truncated");
  const uint32_t version = word_at(bytes, 4), length = word_at(bytes, 8);
  if (version != 2) return failed(path, fmt::format("GLB version {}: only version 2 is read", version));
  if (length > bytes.size()) {
    return failed(path, fmt::format("truncated: {} of {} bytes are there", bytes.size(), length));
  }
  Container container;
  size_t at = 12;
  for (int chunk = 0; length >= at && length - at >= 8; ++chunk) {
    const uint32_t size = word_at(bytes, at), type = word_at(bytes, at + 4);
    at += 8;
    if (size > length - at) return failed(path, fmt::format("GLB chunk {} ends behind the end of the file", chunk));
    if (chunk == 0 && type == kJsonChunk) container.json = bytes.subspan(at, size);
    if (chunk == 1 && type == kBinaryChunk) container.binary = bytes.subspan(at, size);
    at += std::min<size_t>((size_t{size} + 3) / 4 * 4, length - at);
  }
  if (!container.json.data()) return failed(path, "the first chunk of the GLB file is not JSON");
  return container;
}

/// Members of the root that are not used, and what it means for the picture that they are not.
struct Unused {
  const char* name;
  const char* warning;  // or nothing
};
constexpr std::array kUnused{Unused{"textures", "textures are left out: colours are the materials' factors"},
                             Unused{"skins", "skins are left out: meshes stand as they were modelled"},
                             Unused{"animations", "animations are left out"},
                             Unused{"images", nullptr},
                             Unused{"samplers", nullptr},
                             Unused{"extras", nullptr}};

/// Looked for before the text is parsed: the parser's own way to tell takes quadratic time.
bool is_too_deep(std::string_view json) {
  int depth = 0;
  bool in_string = false;
  for (size_t i = 0; i < json.size() && depth <= kMostNested; ++i) {
    const char c = json[i];
    if (c == '"') in_string = !in_string;
    if (in_string) {
      i += c == '\\';
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return depth > kMostNested;
}

Result<Json> parse_json(std::string_view text, const std::string& path) {
  if (is_too_deep(text)) return failed(path, fmt::format("the JSON is nested more than {} deep", kMostNested));
  Json root;
  try {
    root = Json::parse(text);
  } catch (const Json::exception& fault) {
    return failed(path, fmt::format("not valid JSON: {}", fault.what()));
  }
  if (!root.is_object()) return failed(path, "the JSON is not an object: this is no glTF file");
  return root;
}

/// Looks for values of other types than glTF says. A failed check leaves its message in `fault`.
class TypeCheck {
 public:
  std::string fault;

  void object(const Json& object, const std::string& at) {
    for (const auto& [key, value] : object.items()) {
      if (!fault.empty()) return;
      const std::string inner = at.empty() ? key : fmt::format("{}.{}", at, key);
      if (key == "extras") continue;
      if (key == "extensions") {
        const auto lights = value.find("KHR_lights_punctual");
        if (lights != value.end()) any(*lights, inner + ".KHR_lights_punctual", "");
      } else {
        any(value, inner, at.ends_with(".attributes") ? "attributes" : key);
      }
    }
  }

 private:
  static bool is_one_of(std::string_view key, std::initializer_list<std::string_view> keys) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  }
  /// What `key` stands for, if that is a whole number: the largest it may be.
  static std::optional<uint64_t> most(std::string_view key, std::string_view at) {
    // tinygltf keeps the offsets of sparse accessors in 32 bits.
    const bool is_sparse = at.find(".sparse.") != std::string_view::npos;
    if (is_one_of(key, {"byteLength", "byteOffset", "byteStride"})) return is_sparse ? kMostIndex : kMostBytes;
    if (key == "count") return is_sparse ? kMostIndex : kMostBytes;
    if (is_one_of(key, {"attributes", "buffer", "bufferView", "camera", "children", "componentType", "index", "indices",
                        "light", "material", "mesh", "mode", "nodes", "scene"})) {
      return kMostIndex;
    }
    return std::nullopt;
  }

  /// `key` is the member's or, in an array, the array's.
  void any(const Json& value, const std::string& at, std::string_view key) {
    if (!fault.empty()) return;
    if (value.is_object()) return object(value, at);
    if (value.is_array()) {
      size_t i = 0;
      for (const Json& element : value) any(element, fmt::format("{}[{}]", at, i++), key);
      return;
    }
    if (const auto limit = most(key, at)) {
      if (value.is_number_unsigned() && value.get<uint64_t>() <= *limit) return;
      fault = fmt::format("'{}' must be a whole number from 0 to {}", at, *limit);
    } else if (is_one_of(key, {"baseColorFactor", "color", "matrix", "rotation", "scale", "translation"})) {
      if (!value.is_number()) fault = fmt::format("'{}' must be a number", at);
    }
  }
};

/// Refuses what would be misread: other versions, and extensions that change where geometry is.
std::string find_fault(const Json& root) {
  TypeCheck check;
  check.object(root, "");
  if (!check.fault.empty()) return check.fault;
  const auto asset = root.find("asset");
  if (asset == root.end() || !asset->is_object() || !asset->contains("version") || !asset->at("version").is_string()) {
    return "no 'asset.version': this is no glTF 2.0 file";
  }
  const std::string version = asset->at("version");
  if (!version.starts_with("2.")) return fmt::format("glTF version {}: only 2.x is read", version.substr(0, 20));
  const auto required = root.find("extensionsRequired");
  if (required == root.end()) return "";
  for (const Json& extension : *required) {
    const std::string name = extension.is_string() ? extension.get<std::string>() : "?";
    // Materials' and textures' extensions change colours only.
    const bool is_known = name == "KHR_mesh_quantization" || name == "KHR_lights_punctual" ||
                          name.starts_with("KHR_materials_") || name.find("_texture_") != std::string::npos;
    if (!is_known) return fmt::format("the required extension '{}' is not read", name.substr(0, 60));
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
Result<Bytes> find_bytes(const Json& buffer, size_t index, const Container& container, const std::string& path,
                         GltfFile& file) {
  const auto uri = buffer.find("uri");
  if (uri == buffer.end()) {
    if (index == 0 && container.binary) return *container.binary;
    return failed(path, fmt::format("buffer {} has no 'uri', and the file no binary chunk for it", index));
  }
  if (!uri->is_string()) return failed(path, fmt::format("'buffers[{}].uri' must be a string", index));
  const std::string& text = uri->get_ref<const std::string&>();
  if (text.starts_with("data:")) {
    std::string media_type;
    auto& bytes = file.decoded.emplace_back();
    if (!tinygltf::DecodeDataURI(&bytes, media_type, text, 0, false)) {
      return failed(path, fmt::format("the data: URI of buffer {} is empty or not in base64", index));
    }
    return std::as_bytes(std::span(bytes));
  }
  const auto name = relative_file(text);
  if (!name) {
    return failed(path, fmt::format("buffer {} is in {}, but buffers are only read from files beside this one", index,
                                    Json(text.substr(0, 80)).dump(-1, ' ', true, Json::error_handler_t::replace)));
  }
  if (const auto known = file.mapped.find(*name); known != file.mapped.end()) return known->second.bytes();
  Result<MappedFile> mapped = MappedFile::open((std::filesystem::path(path).parent_path() / *name).string());
  if (!mapped) return mapped.error();
  file.size += mapped->bytes().size();
  return file.mapped.emplace(*name, std::move(*mapped)).first->second.bytes();
}

Result<void> open_buffers(const Json& root, const Container& container, const std::string& path, GltfFile& file) {
  const auto buffers = root.find("buffers");
  if (buffers == root.end()) return {};
  for (const Json& buffer : *buffers) {
    const size_t index = file.buffers.size();
    if (!buffer.is_object() || !buffer.contains("byteLength")) {
      return failed(path, fmt::format("buffer {} has no 'byteLength'", index));
    }
    const Result<Bytes> bytes = find_bytes(buffer, index, container, path, file);
    if (!bytes) return bytes.error();
    const uint64_t length = buffer.at("byteLength");
    if (length > bytes->size()) {
      return failed(path, fmt::format("buffer {} has {} of its {} bytes: truncated", index, bytes->size(), length));
    }
    file.buffers.push_back(bytes->first(length));
  }
  return {};
}

}  // namespace

Result<GltfFile> open_gltf(Bytes bytes, const std::string& path) {
  const Result<Container> container = open_container(bytes, path);
  if (!container) return container.error();
  Result<Json> root = parse_json(text_of(container->json), path);
  if (!root) return root.error();
  if (const std::string fault = find_fault(*root); !fault.empty()) return failed(path, fault);

  GltfFile file;
  file.size = bytes.size();
  if (const auto opened = open_buffers(*root, *container, path, file); !opened) return opened.error();
  root->erase("buffers");
  for (const Unused& unused : kUnused) {
    const auto found = root->find(unused.name);
    if (found == root->end()) continue;
    if (unused.warning && !found->empty()) file.warnings.emplace_back(unused.warning);
    root->erase(found);
  }

  const std::string text = root->dump();
  root = Json();
  if (text.size() > std::numeric_limits<uint32_t>::max()) return failed(path, "more than 4 GiB of JSON");
  std::string error, warning;
  const bool parsed = tinygltf::TinyGLTF().LoadASCIIFromString(&file.model, &error, &warning, text.c_str(),
                                                               static_cast<unsigned>(text.size()), "");
  // It says that a primitive is left out, and goes on.
  if (!parsed || !error.empty()) return failed(path, fmt::format("tinygltf: {}", error.substr(0, error.find('\n'))));
  return file;
}

}  // namespace kd::mesh
