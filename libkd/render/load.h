// Loading: what a render needs of a scene, opened and placed, and nothing else.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "image/channels.h"
#include "image/film.h"
#include "nkd/object_file.h"
#include "render/view.h"
#include "scene/instances.h"
#include "scene/scene.h"
#include "sys/result.h"

namespace kd::render {

constexpr uint32_t kMaxSamples = 65536;

struct RenderSettings {
  std::vector<image::Aov> aovs;
  uint32_t samples = 1;  // a pixel, from 1 to kMaxSamples
  bool preview = false;
  double gamma = 2.2;  // > 0; of the preview, and of the film if gamma_on_film
  bool gamma_on_film = false;
  std::optional<image::Window> crop;  // of the film, and the only part that is rendered; not empty, within the film
};

/// One object's sections that this render reads; the others are empty and stay on disk.
struct LoadedObject {
  std::optional<nkd::ObjectFile> file;  // none: no part places the object, and it was not opened
  nkd::Attributes attributes;
};

/// What loading found no need for.
struct Skipped {
  uint32_t objects = 0;   // that no part places: not opened
  uint32_t sections = 0;  // present in opened objects, but read by no stage
  uint32_t black_lights = 0;
  uint32_t aov_buffers = 0;      // AOVs that nobody asked for
  uint32_t shadow_launches = 0;  // a launch for each light that is black
};

struct LoadedScene {
  std::vector<LoadedObject> objects;  // one a scene object
  std::vector<scene::Instance> instances;
  std::vector<HierarchyNode> hierarchy;
  std::vector<LightView> lights;  // none of them black
  std::vector<Material> overrides;
  std::vector<uint32_t> override_of;  // per instance: index into overrides, or kNone
  CameraView camera;
  scene::FilmSize film;
  image::Window window;  // of the film: what is rendered
  Vec3f ambient;
  Vec3f background;
  Skipped skipped;
};

/// Opens the objects that parts place, validates what will be read, and places the instances. Errors as
/// ObjectFile::open and scene::place_instances; ErrorClass::object too for an object whose vertices are float32.
Result<LoadedScene> load_scene(const scene::Scene& scene, const RenderSettings& settings);

/// The parts of a SceneView that are the same on every device.
std::vector<InstanceView> instance_views(const LoadedScene& scene);

}  // namespace kd::render
