#include "mesh/read_mesh.h"

#include <array>
#include <exception>
#include <filesystem>
#include <new>

#include <fmt/format.h>

#include "mesh/formats.h"
#include "sys/mapped_file.h"

namespace kd::mesh {
namespace {

struct Format {
  const char* extension;  // lower case
  const char* description;
  Result<Mesh> (*read)(Bytes bytes, const std::string& path, const ReadOptions& options);
};

constexpr std::array kFormats{
    Format{".obj", "Wavefront OBJ with MTL", read_obj},
    Format{".ply", "Stanford PLY, text or binary", read_ply},
    Format{".stl", "STL, text or binary", read_stl},
    Format{".off", "Object File Format, text", read_off},
};

std::string lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

}  // namespace

std::string supported_formats() {
  std::string list;
  for (const Format& format : kFormats) {
    list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", format.extension, format.description);
  }
  return list;
}

Result<Mesh> read_mesh(const std::string& path, const ReadOptions& options) {
  try {
    Result<MappedFile> file = MappedFile::open(path);
    if (!file) return file.error();
    const std::string extension = lower_case(std::filesystem::path(path).extension().string());
    for (const Format& format : kFormats) {
      if (extension == format.extension) return format.read(file->bytes(), path, options);
    }
    return Error{ErrorClass::mesh, path,
                 fmt::format("no reader for '{}' files; convert to one of {}", extension, supported_formats())};
  } catch (const std::bad_alloc&) {
    return Error{ErrorClass::resource, path, "out of memory while reading; split the mesh or use a larger machine"};
  } catch (const std::exception& fault) {
    return Error{ErrorClass::mesh, path, fmt::format("cannot be read ({}); export the mesh again", fault.what())};
  }
}

}  // namespace kd::mesh
