// Loading: what a render needs of a scene, opened and placed, and nothing else.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "image/channels.h"
#include "image/film.h"
#include "nkd/object_file.h"
#include "render/geometry_checks.h"
#include "render/view.h"
#include "scene/placed_scene.h"
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
  std::optional<TriangleLayout> layout;  // none: expanded, or compact on a device that has no memory for that
  std::optional<image::Window> crop;     // of the film, and the only part that is rendered; not empty, within the film
};

/// One object's sections that this render reads; the others are empty and stay on disk.
struct LoadedObject {
  nkd::ObjectFile file;
  nkd::Attributes attributes;
};

/// What loading found no need for.
struct Skipped {
  uint32_t objects = 0;        // that no part places: not opened
  uint32_t unmet_objects = 0;  // that are placed, but have no instance that a ray can meet: only their headers are read
  uint32_t instances = 0;      // that no ray can meet
  uint32_t sections = 0;       // present in loaded objects, but read by no stage
  uint32_t black_lights = 0;
  uint32_t lights_out_of_reach = 0;  // of every instance
  uint32_t aov_buffers = 0;          // AOVs that nobody asked for
};

struct LoadedScene {
  std::vector<LoadedObject> objects;                   // that rays can meet, in the scene's order
  GeometryChecks checks;                               // of theirs, in the same order
  std::vector<uint32_t> object_numbers;                // of the scene: which those are
  std::vector<uint32_t> object_slots;                  // and back: an index into `objects`, or kNone
  std::vector<std::optional<nkd::Summary>> summaries;  // of the scene's objects; none: no part places it
  std::optional<scene::PlacedScene> placed;
  std::span<const scene::Instance> instances;  // of `placed`, and so are the hierarchy and the numbers
  std::span<const uint32_t> instance_numbers;  // of the scene: which those are; empty: all
  std::span<const uint8_t> front_only;         // 1 for instances whose backs the camera does not see; empty: for none
  std::span<const HierarchyNode> hierarchy;
  std::vector<double> frames;     // that it is loaded for; empty: any
  std::vector<LightView> lights;  // those that can light something
  std::vector<Material> overrides;
  uint32_t most_lights = 0;  // at any frame
  bool moves = false;        // whether anything has keys
  CameraView camera;
  scene::FilmSize film;
  image::Window window;  // of the film: what is rendered
  Vec3f ambient;
  Vec3f background;
  Skipped skipped;

  /// Which needs no hierarchy.
  bool is_one_instance() const { return instances.size() == 1; }
};

/// A still picture.
inline constexpr double kStill[] = {scene::kDefaultFrame};

enum class Extent {
  met,  // what rays can meet in the frames asked for
  all   // that is placed, for any frame
};

enum class Checking {
  done,     // geometry is found sound before load_scene returns
  going_on  // or goes on being checked: nothing is to follow it before LoadedScene::checks says so
};

/// Loads what `frames` of the film need, and stands at the first of them: opens the objects that rays can meet in some
/// of them, validates what will be read, and places their instances (scene/culling.h). Of other objects that parts
/// place the headers are read and validated, which say where they end.
///
/// `scene` must outlive what is loaded and stay as it is. Errors as ObjectFile::open, scene::place_instances,
/// scene::camera_at and scene::lights_at, at any of the frames; ErrorClass::object too for an object whose vertices are
/// float32.
Result<LoadedScene> load_scene(const scene::Scene& scene, const RenderSettings& settings,
                               std::span<const double> frames = kStill, Extent extent = Extent::met,
                               Checking checking = Checking::done);

/// What has moved from one frame to another: these instances, and of the hierarchy whatever is above them, or all of
/// it.
struct Moved {
  std::span<const uint32_t> instances;  // ascending; valid until the next move
};

/// Moves a loaded scene to another of its frames: camera, lights, and the instances that keys move. Sections stay as
/// they are. Errors as load_scene, and ErrorClass::usage for a frame that it is not loaded for; the scene then belongs
/// to no frame.
Result<Moved> move_to(LoadedScene& loaded, const scene::Scene& scene, double frame);

/// What a stage sees of an instance.
InstanceView instance_view(const LoadedScene& scene, const scene::Instance& instance);
std::vector<InstanceView> instance_views(const LoadedScene& scene);

}  // namespace kd::render
