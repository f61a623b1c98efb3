// What a source file holds: meshes, where they stand, and for formats that say so, who looks and what shines.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/frame.h"
#include "mesh/mesh.h"
#include "mesh/read_mesh.h"
#include "sys/result.h"

namespace kd::mesh {

struct NamedMesh {
  std::string name;  // no two in an asset are the same, also without regard to case; fit to be part of a file name
  Mesh mesh;
  uint32_t whole = 0;  // meshes with the same number were one before they were split: normalise them in one box
};

/// One mesh, somewhere in the scene.
struct MeshInstance {
  std::string name;  // may be empty
  uint32_t mesh = 0;
  Frame frame;  // the mesh's model space to scene space
};

struct AssetCamera {
  Vec3d position{0, 0, 0};
  Vec3d target{0, 0, -1};
  Vec3d up{0, 1, 0};
  double vertical_fov_degrees = 45;
};

struct AssetLight {
  bool point = true;          // else directional
  Vec3d position{0, 0, 0};    // of a point light
  Vec3d direction{0, -1, 0};  // of a directional one: the way its light travels, length 1
  Vec3f colour{1, 1, 1};
};

struct Asset {
  std::vector<NamedMesh> meshes;        // at least one
  std::vector<MeshInstance> instances;  // each mesh may have any number of them
  std::optional<AssetCamera> camera;
  std::vector<AssetLight> lights;
  std::vector<std::string> warnings;  // of the file as a whole; a mesh's own are with it

  /// Whether this is one mesh that stands where it was made: what an object alone can say.
  bool is_plain_mesh() const;
};

enum class Split : uint8_t { none, object, material };

/// Reads `path` as `read_mesh` does, and glTF 2.0 (.gltf, .glb) with all its meshes. `split` makes one mesh of each
/// OBJ group or object, or of each material of a mesh; where there is nothing to split by, a warning says so. Meshes
/// are named after what they were split by, and else by their names in the file, or after the file. Errors as
/// `read_mesh`, and ErrorClass::missing for a file that a glTF file needs.
Result<Asset> read_asset(const std::string& path, const ReadOptions& options, Split split);

}  // namespace kd::mesh
