#include "mesh/read_mesh.h"

#include "mesh/formats.h"

namespace kd::mesh {

Result<Mesh> read_mesh(const std::string& path, const ReadOptions& options) {
  return read_file<Mesh>(path, [&](Bytes bytes, const Format& format) -> Result<Mesh> {
    if (format.read_mesh) return format.read_mesh(bytes, path, options);
    return Error{ErrorClass::mesh, path, "holds a scene, not one mesh; compile it with kdbuild"};
  });
}

}  // namespace kd::mesh
