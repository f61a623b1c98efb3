#include "mesh/gltf_json.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mesh/text.h"

namespace kd::mesh {
namespace {

using Json = nlohmann::json;

constexpr int kMostNested = 64;  // arrays and objects around a value
constexpr uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;

uint32_t word_at(Bytes bytes, size_t offset) {
  uint32_t word;
  std::memcpy(&word, bytes.data() + offset, sizeof word);
  return word;
}

/// Where the chunk behind one that ends at `end` begins. A chunk's length is to be a multiple of four; of those that
/// are not, some writers pad them and some do not.
size_t next_chunk(Bytes bytes, size_t end) {
  const bool is_there = bytes.size() - end >= 8 && word_at(bytes, end + 4) == kBinaryChunk;
  return is_there ? end : std::min((end + 3) / 4 * 4, bytes.size());
}

/// Looked for before the text is parsed: the parser's own way to tell takes quadratic time.
bool is_too_deep(std::string_view json, Watch& watch) {
  int depth = 0;
  bool in_string = false;
  for (size_t i = 0; i < json.size() && depth <= kMostNested; ++i) {
    watch.step();
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

/// The text for the parser, character by character.
class WatchedText {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  WatchedText(const char* at, Watch& watch) : at_(at), watch_(&watch) {}

  const char& operator*() const { return *at_; }
  WatchedText& operator++() {
    ++at_;
    watch_->step();
    return *this;
  }
  WatchedText operator++(int) {
    const WatchedText old = *this;
    ++*this;
    return old;
  }
  bool operator==(const WatchedText& other) const { return at_ == other.at_; }

 private:
  const char* at_;
  Watch* watch_;
};

}  // namespace

Error gltf_error(const std::string& path, std::string what) {
  what.resize(std::min(what.size(), size_t{300}));
  for (char& c : what) {
    if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = ' ';
  }
  return {ErrorClass::mesh, path, what + "; export the mesh again"};
}

Result<GltfContainer> open_container(Bytes bytes, const std::string& path) {
  constexpr uint32_t kMagic = 0x46546c67;
  if (bytes.size() < 4 || word_at(bytes, 0) != kMagic) return GltfContainer{bytes, {}};
  if (bytes.size() < 12) return gltf_error(path, "a GLB header has 12 bytes, and the file fewer: it is truncated");
  const uint32_t version = word_at(bytes, 4), length = word_at(bytes, 8);
  if (version != 2) return gltf_error(path, fmt::format("GLB version {}: only version 2 is read", version));
  if (length > bytes.size()) {
    return gltf_error(path, fmt::format("truncated: {} of {} bytes are there", bytes.size(), length));
  }
  bytes = bytes.first(length);
  GltfContainer container;
  size_t at = 12;
  for (int chunk = 0; bytes.size() >= at && bytes.size() - at >= 8; ++chunk) {
    const uint32_t size = word_at(bytes, at), type = word_at(bytes, at + 4);
    at += 8;
    if (size > bytes.size() - at) {
      return gltf_error(path, fmt::format("GLB chunk {} ends behind the end of the file", chunk));
    }
    if (chunk == 0 && type == kJsonChunk) container.json = bytes.subspan(at, size);
    if (chunk == 1 && type == kBinaryChunk) container.binary = bytes.subspan(at, size);
    at = next_chunk(bytes, at + size);
  }
  if (!container.json.data()) return gltf_error(path, "the first chunk of the GLB file is not JSON");
  return container;
}

Result<Json> parse_gltf_json(std::string_view text, const std::string& path, Watch& watch) {
  if (is_too_deep(text, watch))
    return gltf_error(path, fmt::format("the JSON is nested more than {} deep", kMostNested));
  Json root;
  try {
    root = Json::parse(WatchedText(text.data(), watch), WatchedText(text.data() + text.size(), watch));
  } catch (const Json::exception& fault) {
    return gltf_error(path, fmt::format("not valid JSON: {}", fault.what()));
  }
  if (!root.is_object()) return gltf_error(path, "the JSON is not an object: this is no glTF file");
  return root;
}

}  // namespace kd::mesh
