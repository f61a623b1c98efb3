// What whole-pipeline tests share: meshes compiled to a temporary folder, scenes of them, renders of scenes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"
#include "render/device_group.h"
#include "scene/scene.h"
#include "support/temp_folder.h"

namespace kd::test {

/// The checkout, and the folder of real meshes beside it (which may be absent). KD_SOURCE_DIR and KD_SHARED_DIR in the
/// environment override where the build was, for machines that only run what was built elsewhere.
std::filesystem::path source_root();
std::filesystem::path shared_data();

/// The meshes there, without their .ply; each has a camera file of the same name.
inline constexpr const char* kRealMeshes[] = {"sibenik",
                                              "sponza",
                                              "bunny",
                                              "dragon_res2",
                                              "teapot",
                                              "staircase",
                                              "living_room",
                                              "bad_beetle",
                                              "bad_legocar",
                                              "bad_cycloidal",
                                              "bad_thingi_112932",
                                              "bad_thingi_1514499"};

/// A real mesh, unpacked if it lies there as .xz; nothing if it is not there.
std::optional<std::filesystem::path> shared_mesh(const std::string& name);

/// A temporary folder in which meshes are compiled.
class Workshop {
 public:
  /// Compiles a mesh, and returns the object's path.
  std::string compile(const std::filesystem::path& mesh, int bits = 21);
  /// A scene file of data/ with the objects it places compiled beside it.
  scene::Scene data_scene(const std::string& name);
  std::filesystem::path folder() const { return folder_.path(); }

 private:
  TempFolder folder_;
};

/// A camera file: position, target, up, vertical field of view, light.
struct CameraFile {
  scene::Camera camera;
  Vec3d light;
};
CameraFile read_camera_file(const std::filesystem::path& path);

/// One object under its camera and light, 512 x 512.
scene::Scene object_scene(const std::string& object, const CameraFile& camera);

/// Renders with every AOV and a preview; fails the test on any error.
render::Frame render_all(const scene::Scene& scene, const render::Device& device,
                         TriangleLayout layout = TriangleLayout::expanded);

}  // namespace kd::test
