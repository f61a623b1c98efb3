#include "mesh/formats.h"

#include <array>
#include <filesystem>

#include <fmt/format.h>

#include "mesh/text.h"

namespace kd::mesh {
namespace {

constexpr std::array kFormats{
    Format{".obj", "Wavefront OBJ with MTL", read_obj, nullptr},
    Format{".ply", "Stanford PLY, text or binary", read_ply, nullptr},
    Format{".stl", "STL, text or binary", read_stl, nullptr},
    Format{".off", "Object File Format, text", read_off, nullptr},
    Format{".gltf", "glTF 2.0", nullptr, read_gltf},
    Format{".glb", "glTF 2.0, binary", nullptr, read_gltf},
};

}  // namespace

Result<const Format*> find_format(const std::string& path) {
  const std::string extension = lower_case(std::filesystem::path(path).extension().string());
  for (const Format& format : kFormats) {
    if (extension == format.extension) return &format;
  }
  return Error{ErrorClass::mesh, path,
               fmt::format("no reader for '{}' files; convert to one of {}", extension, supported_formats())};
}

std::string supported_formats() {
  std::string list;
  for (const Format& format : kFormats) {
    list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", format.extension, format.description);
  }
  return list;
}

}  // namespace kd::mesh
