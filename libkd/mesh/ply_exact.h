// What OpenMesh's PLY reader narrows: it hands every coordinate on as float32, of whatever type it is in the file.
#pragma once

#include <string_view>
#include <vector>

#include "core/vec.h"
#include "mesh/ply_header.h"
#include "mesh/watch.h"

namespace kd::mesh {

/// Writes the coordinates that the file declares as float64 into `positions`, in full. `data` is what follows the
/// header and has been read once without error; no list may come before or among the vertex properties.
void restore_doubles(const PlyHeader& header, std::string_view data, std::vector<Vec3d>& positions, Watch& watch);

}  // namespace kd::mesh
