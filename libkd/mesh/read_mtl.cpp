#include "mesh/read_mtl.h"

#include <cmath>
#include <filesystem>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

#include "mesh/text.h"
#include "sys/mapped_file.h"

namespace kd::mesh {
namespace {

std::string trimmed(const std::string& name) {
  const size_t first = name.find_first_not_of(" \t\r"), last = name.find_last_not_of(" \t\r");
  return first == std::string::npos ? "" : name.substr(first, last - first + 1);
}

/// Per `newmtl` line with a name, whether a Ka line follows: tinyobjloader does not tell Ka 0 from none.
std::vector<bool> find_ambient(std::string_view text) {
  std::vector<bool> has_ambient;
  Tokens tokens(text);
  do {
    const std::string_view keyword = tokens.next_in_line();
    if (keyword == "newmtl" && !tokens.next_in_line().empty()) has_ambient.push_back(false);
    if (keyword == "Ka" && !has_ambient.empty()) has_ambient.back() = true;
  } while (tokens.next_line());
  return has_ambient;
}

}  // namespace

int MtlReader::find(std::string name) const {
  const auto found = index_of_.find(trimmed(name));
  return found == index_of_.end() ? -1 : found->second;
}

bool MtlReader::operator()(const std::string& file, std::vector<tinyobj::material_t>*, std::map<std::string, int>*,
                           std::string*, std::string*) {
  const std::string path = (std::filesystem::path(obj_path_).parent_path() / file).string();
  const auto mapped = MappedFile::open(path);
  if (!mapped) {
    warnings.push_back(fmt::format("materials left out: {}", mapped.error().line()));
    return false;
  }
  const std::string_view text = text_of(mapped->bytes());
  std::istringstream in{std::string(text)};
  std::vector<tinyobj::material_t> read;
  std::map<std::string, int> map;
  std::string warning, error;
  tinyobj::LoadMtl(&map, &read, &in, &warning, &error);
  const std::vector<bool> has_ambient = find_ambient(text);
  size_t named = 0;
  for (const auto& material : read) {
    if (trimmed(material.name).empty()) continue;  // what precedes the first newmtl
    add(material, named < has_ambient.size() && has_ambient[named]);
    ++named;
  }
  return true;
}

void MtlReader::add(const tinyobj::material_t& source, bool has_ambient) {
  const std::string name = trimmed(source.name);
  const auto checked = [&](const char* key, double value, float fallback) {
    const auto narrow = static_cast<float>(value);
    if (std::isfinite(narrow) && value >= 0) return narrow;
    warnings.push_back(fmt::format("material '{}': {} of {} replaced by {}", name, key, value, fallback));
    return fallback;
  };
  const auto colour = [&](const char* key, const double* values, Vec3f fallback) {
    return Vec3f{checked(key, values[0], fallback.x), checked(key, values[1], fallback.y),
                 checked(key, values[2], fallback.z)};
  };
  const Material standard;
  Material material;
  material.diffuse = colour("Kd", source.diffuse, standard.diffuse);
  material.specular = colour("Ks", source.specular, standard.specular);
  material.shininess = checked("Ns", source.shininess, standard.shininess);
  material.emission = colour("Ke", source.emission, standard.emission);
  material.ambient =
      has_ambient && !ambient_from_diffuse_ ? colour("Ka", source.ambient, standard.ambient) : material.diffuse;
  if (index_of_.emplace(name, static_cast<int>(materials.size())).second) {
    materials.push_back(material);
    names.push_back(name);
  }
}

}  // namespace kd::mesh
