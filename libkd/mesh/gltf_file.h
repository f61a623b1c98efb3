// A glTF 2.0 file taken apart: its JSON as tinygltf's structs, its buffers as bytes. Numbers in the structs are whole
// where they should be and not negative, but nothing says yet that what they count or point to is there.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "mesh/formats.h"
#include "mesh/tinygltf.h"
#include "sys/mapped_file.h"

namespace kd::mesh {

struct GltfFile {
  tinygltf::Model model;       // without buffers, images and what else is not used
  std::vector<Bytes> buffers;  // each as long as its byteLength says
  uint64_t size = 0;           // of the file and the buffers outside it, in bytes
  std::vector<std::string> warnings;

  std::map<std::string, MappedFile> mapped;     // what `buffers` points into, beside the file itself, by name
  std::vector<std::vector<std::byte>> decoded;  // the same, from data: URIs
};

/// `bytes`, JSON or a GLB container, must outlive what is returned. Buffers may be in the container, in data: URIs or
/// in files in or below the folder of `path`. ErrorClass::mesh, or ErrorClass::missing for a buffer's file.
/// Throws Cancelled.
Result<GltfFile> open_gltf(Bytes bytes, const std::string& path, Watch& watch);

}  // namespace kd::mesh
