// The readers behind the table in formats.cpp. `bytes` is the whole file, `path` its name for messages and for files
// beside it. They may throw std::bad_alloc, std::length_error and Cancelled, which `read_file` turns into errors.
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <new>
#include <span>
#include <string>

#include "mesh/asset.h"
#include "mesh/read_mesh.h"
#include "mesh/watch.h"
#include "sys/mapped_file.h"

namespace kd::mesh {

using Bytes = std::span<const std::byte>;

Result<Mesh> read_obj(Bytes bytes, const std::string& path, const ReadOptions& options);
Result<Mesh> read_ply(Bytes bytes, const std::string& path, const ReadOptions& options);
Result<Mesh> read_stl(Bytes bytes, const std::string& path, const ReadOptions& options);
Result<Mesh> read_off(Bytes bytes, const std::string& path, const ReadOptions& options);
Result<Asset> read_gltf(Bytes bytes, const std::string& path, const ReadOptions& options);

/// A row of the table. One of the readers is there.
struct Format {
  const char* extension;  // lower case
  const char* description;
  Result<Mesh> (*read_mesh)(Bytes bytes, const std::string& path, const ReadOptions& options);
  Result<Asset> (*read_asset)(Bytes bytes, const std::string& path, const ReadOptions& options);
};

/// The row of `path`'s extension, in any case; ErrorClass::mesh if there is none.
Result<const Format*> find_format(const std::string& path);

/// What `read` makes of the file, which has a format; what it throws becomes an error.
template <class T>
Result<T> read_file(const std::string& path, const std::function<Result<T>(Bytes bytes, const Format& format)>& read) {
  try {
    Result<MappedFile> file = MappedFile::open(path);
    if (!file) return file.error();
    const Result<const Format*> format = find_format(path);
    if (!format) return format.error();
    return read(file->bytes(), **format);
  } catch (const Cancelled&) {
    return Error{ErrorClass::interrupted, path, "interrupted"};
  } catch (const std::bad_alloc&) {
    return Error{ErrorClass::resource, path, "out of memory while reading; split the mesh or use a larger machine"};
  } catch (const std::exception& fault) {
    return Error{ErrorClass::mesh, path, std::string("cannot be read (") + fault.what() + "); export the mesh again"};
  }
}

}  // namespace kd::mesh
