#include "render/load.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/nesting.h"

namespace kd::render {

namespace {

bool is_black(Vec3f c) { return c.x == 0 && c.y == 0 && c.z == 0; }

/// Which attribute sections some stage of this render reads.
struct Needs {
  bool materials = false;
  bool normals = false;
  bool source_primitives = false;
};

Needs needs_of(const scene::Scene& scene, const std::vector<scene::Light>& lights, const RenderSettings& settings) {
  const auto asked = [&](image::Aov aov) {
    return std::find(settings.aovs.begin(), settings.aovs.end(), aov) != settings.aovs.end();
  };
  const bool lit = std::any_of(lights.begin(), lights.end(), [](const auto& l) { return !is_black(l.colour); });
  return {lit || !is_black(scene.ambient), lit || asked(image::Aov::normal), asked(image::Aov::primitive)};
}

Result<void> load_attributes(LoadedObject& object, const Needs& needs, Skipped& skipped) {
  const nkd::ObjectFile& file = *object.file;
  if (file.has_materials()) {
    if (needs.materials) {
      auto materials = file.materials();
      if (!materials) return materials.error();
      object.attributes.materials = materials->values;
      object.attributes.material_ids = materials->ids;
    } else {
      skipped.sections += 2;
    }
  }
  if (file.has_normals()) {
    if (needs.normals) {
      auto normals = file.normals();
      if (!normals) return normals.error();
      object.attributes.normals = normals->values;
      object.attributes.normal_indices = normals->indices;
    } else {
      skipped.sections += 2;
    }
  }
  if (file.has_source_primitives()) {
    if (needs.source_primitives) {
      auto sources = file.source_primitives();
      if (!sources) return sources.error();
      object.attributes.source_primitives = *sources;
    } else {
      skipped.sections += 1;
    }
  }
  return {};
}

CameraView camera_view(const scene::Camera& camera, scene::FilmSize film) {
  const Vec3d forward = normalised(camera.target - camera.position);
  const Vec3d right = normalised(cross(forward, normalised(camera.up)));
  const Vec3d up = cross(right, forward);
  const double half_height = std::tan(camera.vertical_fov_degrees * std::numbers::pi / 360);
  const double pixel = 2 * half_height / film.height;
  CameraView view;
  view.position = camera.position;
  view.right = right * pixel;
  view.down = up * -pixel;
  view.corner = forward + view.right * (0.5 - 0.5 * film.width) + view.down * (0.5 - 0.5 * film.height);
  return view;
}

void load_lights(const std::vector<scene::Light>& lights, LoadedScene& loaded) {
  for (const scene::Light& light : lights) {
    if (is_black(light.colour)) {
      ++loaded.skipped.black_lights;
      ++loaded.skipped.shadow_launches;
      continue;
    }
    const bool point = light.kind != scene::LightKind::directional;
    loaded.lights.push_back({point ? light.position : -light.direction, light.colour, point ? 1u : 0u});
  }
}

}  // namespace

Result<LoadedScene> load_scene(const scene::Scene& scene, const RenderSettings& settings) {
  LoadedScene loaded;
  const auto camera = scene::camera_at(scene, scene::kDefaultFrame);
  if (!camera) return camera.error();
  const auto lights = scene::lights_at(scene, scene::kDefaultFrame);
  if (!lights) return lights.error();
  const Needs needs = needs_of(scene, *lights, settings);
  std::vector<Lattice> lattices(scene.objects.size());
  loaded.objects.resize(scene.objects.size());
  const std::vector<scene::ObjectUse> uses = scene::object_uses(scene);
  for (uint32_t i = 0; i < scene.objects.size(); ++i) {
    if (!uses[i].placed) {
      ++loaded.skipped.objects;
      continue;
    }
    auto file = nkd::ObjectFile::open(scene.objects[i].file);
    if (!file) return file.error();
    if (file->geometry().form != VertexForm::lattice) {
      return Error{ErrorClass::object, scene.objects[i].file,
                   "its vertices are float32, for benchmarks only, and rendering is exact on the lattice: compile it "
                   "without --vertices float32"};
    }
    lattices[i] = file->summary().lattice;
    loaded.objects[i].file = std::move(*file);
    Needs own = needs;
    own.materials = needs.materials && uses[i].own_materials;
    if (auto attributes = load_attributes(loaded.objects[i], own, loaded.skipped); !attributes)
      return attributes.error();
  }

  auto instances = scene::place_instances(scene, lattices);
  if (!instances) return instances.error();
  loaded.instances = std::move(*instances);
  loaded.hierarchy = scene::build_hierarchy(loaded.instances);
  loaded.overrides = scene::override_materials(scene);
  static_assert(kNone == scene::kOwnMaterials);
  for (const scene::Instance& instance : loaded.instances) loaded.override_of.push_back(instance.material);
  load_lights(*lights, loaded);
  loaded.camera = camera_view(*camera, scene.film);
  loaded.film = scene.film;
  loaded.window = settings.crop.value_or(image::Window{0, 0, scene.film.width, scene.film.height});
  loaded.ambient = scene.ambient;
  loaded.background = scene.background;
  loaded.skipped.aov_buffers = static_cast<uint32_t>(image::kAovRows.size() - settings.aovs.size());
  return loaded;
}

std::vector<InstanceView> instance_views(const LoadedScene& scene) {
  std::vector<InstanceView> views;
  views.reserve(scene.instances.size());
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    const scene::Instance& instance = scene.instances[i];
    views.push_back({instance.scene_to_lattice, instance.lattice_to_scene, instance.object, scene.override_of[i]});
  }
  return views;
}

}  // namespace kd::render
