// glTF files written by hand: buffers as data: URIs, GLB containers, and a small sound file to start from.
#pragma once

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>

#include <doctest/doctest.h>
#include <fmt/format.h>

namespace kd::test {

template <class T>
std::string raw(std::initializer_list<T> values) {
  std::string bytes;
  for (const T value : values) {
    char one[sizeof(T)];
    std::memcpy(one, &value, sizeof(T));
    bytes.append(one, sizeof(T));
  }
  return bytes;
}

inline std::string base64(const std::string& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<uint8_t>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

inline std::string data_uri(const std::string& bytes) {
  return "data:application/octet-stream;base64," + base64(bytes);
}

inline std::string glb(std::string json, std::string binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  const auto size = [](size_t n) { return static_cast<uint32_t>(n); };
  return raw<uint32_t>({0x46546c67, 2, size(28 + json.size() + binary.size()), size(json.size()), 0x4e4f534a}) + json +
         raw<uint32_t>({size(binary.size()), 0x004e4942}) + binary;
}

/// `text` with the first `from` replaced; a test that does not find it fails.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  REQUIRE_MESSAGE(at != std::string::npos, from);
  return text.replace(at, from.size(), to);
}

/// The unit square in z = 0 as two triangles: four positions, four normals along z, six 16-bit indices.
inline std::string square_bytes() {
  return raw<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) + raw<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}) +
         raw<uint16_t>({0, 1, 2, 0, 2, 3});
}

/// A file with the square as its only mesh and node; `buffer` says where its bytes are, `more` is put behind.
inline std::string square_json(const std::string& buffer, const std::string& more = "") {
  return fmt::format(
      R"({{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": 108{}}}],
"bufferViews": [{{"buffer": 0, "byteLength": 48}}, {{"buffer": 0, "byteOffset": 48, "byteLength": 48}},
 {{"buffer": 0, "byteOffset": 96, "byteLength": 12}}],
"accessors": [{{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}},
 {{"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"}},
 {{"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}}],
"meshes": [{{"name": "square", "primitives": [{{"attributes": {{"POSITION": 0, "NORMAL": 1}}, "indices": 2}}]}}],
"nodes": [{{"mesh": 0}}]{}}})",
      buffer, more);
}

/// The same with its bytes in a data: URI.
inline std::string square_gltf(const std::string& more = "") {
  return square_json(fmt::format(R"(, "uri": "{}")", data_uri(square_bytes())), more);
}

}  // namespace kd::test
