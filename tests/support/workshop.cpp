#include "support/workshop.h"

#include <cstdlib>
#include <fstream>

#include <doctest/doctest.h>
#include <unistd.h>

#include "kdbuild/build_source.h"
#include "scene/parse_scene.h"

namespace kd::test {

namespace fs = std::filesystem;

namespace {

fs::path from_environment(const char* name, const fs::path& otherwise) {
  const char* value = std::getenv(name);
  return value ? fs::path(value) : otherwise;
}

}  // namespace

fs::path source_root() { return from_environment("KD_SOURCE_DIR", KD_SOURCE_DIR); }
fs::path shared_data() { return from_environment("KD_SHARED_DIR", source_root().parent_path() / "shared" / "data"); }

std::optional<fs::path> shared_mesh(const std::string& name) {
  const fs::path plain = shared_data() / name;
  if (fs::exists(plain)) return plain;
  const fs::path packed = shared_data() / (name + ".xz");
  const fs::path unpacked = fs::temp_directory_path() / ("kdtrace-" + std::to_string(getuid()) + "-" + name);
  if (!fs::exists(packed)) return std::nullopt;
  if (!fs::exists(unpacked)) {
    const std::string partial = unpacked.string() + "." + std::to_string(getpid());
    if (std::system(("xz -dc '" + packed.string() + "' > '" + partial + "'").c_str()) != 0) return std::nullopt;
    fs::rename(partial, unpacked);
  }
  return unpacked;
}

std::string Workshop::compile(const fs::path& mesh, int bits) {
  const fs::path object = folder() / "compiled" / mesh.stem().concat(".nkd");
  fs::create_directories(object.parent_path());
  tools::CompileSettings settings;
  settings.bits = bits;
  const auto report = tools::build_object(mesh.string(), object.string(), settings);
  REQUIRE_MESSAGE(report, (report ? "" : report.error().line()));
  return object.string();
}

scene::Scene Workshop::data_scene(const std::string& name) {
  const fs::path scene_file = folder() / name;
  fs::copy_file(source_root() / "data" / name, scene_file, fs::copy_options::overwrite_existing);
  auto scene = scene::read_scene(scene_file.string());
  REQUIRE_MESSAGE(scene, (scene ? "" : scene.error().line()));
  for (const scene::SceneObject& object : scene->objects) {
    const std::string stem = fs::path(object.file).stem().string();
    const fs::path obj = source_root() / "data" / (stem + ".obj"), ply = source_root() / "data" / (stem + ".ply");
    compile(fs::exists(obj) ? obj : ply);
  }
  return *scene;
}

CameraFile read_camera_file(const fs::path& path) {
  std::ifstream file(path);
  double n[13] = {};
  for (double& value : n) file >> value;
  REQUIRE_MESSAGE(file, path.string());
  CameraFile out;
  out.camera = {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]}, n[9]};
  out.light = {n[10], n[11], n[12]};
  return out;
}

scene::Scene object_scene(const std::string& object, const CameraFile& camera) {
  scene::Scene s;
  s.path = "object_scene";
  s.film = {512, 512};
  s.camera = camera.camera;
  s.background = {0.1f, 0.2f, 0.3f};
  s.ambient = {0.2f, 0.2f, 0.2f};
  s.lights.push_back({scene::LightKind::point, camera.light, {0, -1, 0}, {0.8f, 0.7f, 0.6f}});
  s.lights.push_back({scene::LightKind::directional, {0, 0, 0}, normalised({0.3, -1, 0.2}), {0.1f, 0.2f, 0.3f}});
  s.objects.push_back({"object", object});
  scene::Part part;
  s.characters.push_back({"", {part}});
  return s;
}

render::Frame render_all(const scene::Scene& scene, const render::Device& device, TriangleLayout layout) {
  render::RenderSettings settings;
  settings.layout = layout;
  for (const image::AovRow& row : image::kAovRows) settings.aovs.push_back(row.aov);
  settings.preview = true;
  auto loaded = render::load_scene(scene, settings);
  REQUIRE_MESSAGE(loaded, (loaded ? "" : loaded.error().line()));
  auto group = render::DeviceGroup::open({device}, false, *loaded, settings);
  REQUIRE_MESSAGE(group, (group ? "" : group.error().line()));
  auto frame = group->render({});
  REQUIRE_MESSAGE(frame, (frame ? "" : frame.error().line()));
  return std::move(*frame);
}

}  // namespace kd::test
