// Materials of an OBJ file: MTL, through tinyobjloader.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/material.h"
#include "mesh/tinyobj.h"

namespace kd::mesh {

/// The materials of every MTL file that an OBJ names, as tinyobjloader asks for them. Ka, Kd, Ks and Ns are used. A
/// material without a Ka line, or any material if `ambient_from_diffuse`, has its diffuse colour as ambient. A number
/// that is negative or not finite becomes the default material's; tinyobjloader reads what is no number as 0.
class MtlReader final : public tinyobj::MaterialReader {
 public:
  MtlReader(std::string obj_path, bool ambient_from_diffuse)
      : obj_path_(std::move(obj_path)), ambient_from_diffuse_(ambient_from_diffuse) {}

  std::vector<Material> materials;
  std::vector<std::string> names;
  std::vector<std::string> warnings;

  /// The first material of that name, or -1. White space around a name does not count.
  int find(std::string name) const;

  bool operator()(const std::string& file, std::vector<tinyobj::material_t>* unused_materials,
                  std::map<std::string, int>* unused_map, std::string* warning, std::string* error) override;

 private:
  void add(const tinyobj::material_t& source, bool has_ambient);

  std::string obj_path_;
  bool ambient_from_diffuse_;
  std::map<std::string, int> index_of_;
};

}  // namespace kd::mesh
