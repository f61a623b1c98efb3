// Which further files a mesh file names, found without parsing it as a mesh: what has to be looked at to tell whether
// anything that an object was made from has changed.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/watch.h"
#include "sys/result.h"

namespace kd::mesh {

/// The files that reading the mesh `bytes` of `path` reads as well if they are there, each once, in order of mention.
/// Never fewer; more where an OBJ offers a second MTL for the case that the first is missing. ErrorClass::interrupted
/// if `progress`, which is asked with a share of 0, cancels.
Result<std::vector<std::string>> dependencies(std::span<const std::byte> bytes, const std::string& path,
                                              const Progress& progress = {});

/// The same of an OBJ's text: what its mtllib lines name. Throws Cancelled.
std::vector<std::string> mtl_files(std::string_view text, const std::string& path, Watch& watch);

}  // namespace kd::mesh
