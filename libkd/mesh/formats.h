// The readers behind the table in read_mesh.cpp. `bytes` is the whole file, `path` its name for messages and for files
// beside it. They may throw std::bad_alloc and std::length_error, which `read_mesh` turns into errors.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "mesh/read_mesh.h"

namespace kd::mesh {

using Bytes = std::span<const std::byte>;

Result<Mesh> read_obj(Bytes bytes, const std::string& path, const ReadOptions& options);
Result<Mesh> read_ply(Bytes bytes, const std::string& path, const ReadOptions& options);
Result<Mesh> read_stl(Bytes bytes, const std::string& path, const ReadOptions& options);
Result<Mesh> read_off(Bytes bytes, const std::string& path, const ReadOptions& options);

}  // namespace kd::mesh
