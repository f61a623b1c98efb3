// Reads mesh files: every triangle of the source, in its order, with the coordinates it gives. Nothing is dropped,
// merged or moved here; `mesh/clean.h` judges.
#pragma once

#include <string>

#include "mesh/mesh.h"
#include "sys/progress.h"
#include "sys/result.h"

namespace kd::mesh {

struct ReadOptions {
  /// MTL: ambient := diffuse, whatever Ka says; many exporters write 0 or 1 without meaning it.
  bool ambient_from_diffuse = false;
  /// Asked now and then, with a share of 0, by the calling thread; to cancel takes less than 100 ms, on any file.
  Progress progress{};
};

/// The mesh in `path`, whose extension (in any case) names the format; glTF, which holds more than one, is left to
/// `read_asset`. Polygons become triangles: convex ones a fan
/// from their first corner, concave ones by ear clipping. Coordinates may be NaN or infinite (in text PLY
/// they are an error). Safe to call from several
/// threads at once.
/// ErrorClass::missing: no such file, or not one that can be read. ErrorClass::mesh: an unknown extension, a file that
/// does not parse, a face with a vertex that is not there, no face at all. ErrorClass::resource: memory ran out.
/// ErrorClass::interrupted: cancelled.
Result<Mesh> read_mesh(const std::string& path, const ReadOptions& options);

/// The extensions and what they stand for, for messages: ".obj (Wavefront OBJ), ...".
std::string supported_formats();

}  // namespace kd::mesh
