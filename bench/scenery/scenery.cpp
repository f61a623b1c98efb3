#include "scenery/scenery.h"

#include "common/console.h"
#include "sys/atomic_file.h"

namespace kd::bench::scenery {

Result<void> write_meshes(const std::string& folder, const std::string& library, std::span<const NamedMesh> meshes) {
  const std::string library_file = library + ".mtl";
  if (auto written = write_file(folder + "/" + library_file, library_text(meshes)); !written) return written;
  for (const NamedMesh& m : meshes) {
    if (tools::interrupted()) return Error{ErrorClass::interrupted, folder, "interrupted"};
    if (auto written = write_file(folder + "/" + m.name + ".obj", m.mesh.text(m.name, library_file)); !written)
      return written;
  }
  return {};
}

}  // namespace kd::bench::scenery
