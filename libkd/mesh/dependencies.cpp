#include "mesh/dependencies.h"

#include <algorithm>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "mesh/gltf_json.h"
#include "mesh/text.h"

namespace kd::mesh {

namespace {

/// As tinyobjloader parts them: at spaces that no backslash stands before.
std::vector<std::string> split_names(std::string_view list) {
  std::vector<std::string> names(1);
  bool escaped = false;
  for (const char c : list) {
    if (!escaped && c == '\\') {
      escaped = true;
    } else if (!escaped && c == ' ') {
      names.emplace_back();
    } else {
      names.back() += c;
      escaped = false;
    }
  }
  std::erase(names, "");
  return names;
}

/// Lines that end in a backslash go on in the next.
std::string rest_of_line(std::string_view text, size_t start) {
  std::string line;
  while (start < text.size()) {
    const size_t end = std::min(text.find_first_of("\r\n", start), text.size());
    line += text.substr(start, end - start);
    if (!line.ends_with('\\')) break;
    line.back() = ' ';
    start = end + (text.substr(end).starts_with("\r\n") ? 2 : 1);
  }
  return line;
}

std::vector<std::string> buffer_files(std::span<const std::byte> bytes, const std::string& path, Watch& watch) {
  std::vector<std::string> files;
  const auto container = open_container(bytes, path);
  if (!container) return files;
  const auto root = parse_gltf_json(text_of(container->json), path, watch);
  if (!root || !root->contains("buffers")) return files;
  for (const auto& buffer : root->at("buffers")) {
    if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string()) continue;
    const std::string uri = buffer["uri"];
    if (uri.starts_with("data:")) continue;
    const std::string file = (std::filesystem::path(path).parent_path() / decoded_uri(uri)).string();
    if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
  }
  return files;
}

}  // namespace

Result<std::vector<std::string>> dependencies(std::span<const std::byte> bytes, const std::string& path,
                                              const Progress& progress) {
  const std::string extension = lower_case(std::filesystem::path(path).extension().string());
  Watch watch(progress);
  try {
    if (extension == ".obj") return mtl_files(text_of(bytes), path, watch);
    if (extension == ".gltf" || extension == ".glb") return buffer_files(bytes, path, watch);
  } catch (const Cancelled&) {
    return Error{ErrorClass::interrupted, path, "interrupted"};
  }
  return std::vector<std::string>();
}

std::vector<std::string> mtl_files(std::string_view text, const std::string& path, Watch& watch) {
  std::vector<std::string> files;
  Tokens tokens(text);
  do {
    watch.step();
    if (tokens.next_in_line() != "mtllib") continue;
    const std::string list = rest_of_line(text, tokens.offset());
    if (list.empty()) continue;
    for (const std::string& name : split_names(std::string_view(list).substr(1))) {
      const std::string file = (std::filesystem::path(path).parent_path() / name).string();
      if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
    }
  } while (tokens.next_line());
  return files;
}

}  // namespace kd::mesh
