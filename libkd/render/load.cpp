#include "render/load.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "scene/camera_axes.h"
#include "scene/nesting.h"

namespace kd::render {

namespace {

/// Which attribute sections some stage of this render reads.
struct Needs {
  bool materials = false;
  bool normals = false;
  bool source_primitives = false;
};

/// At some frame.
bool may_shine(const scene::Light& light) {
  return !scene::is_black(light.colour) ||
         std::any_of(light.keys.begin(), light.keys.end(),
                     [](const scene::LightKey& key) { return key.colour && !scene::is_black(*key.colour); });
}

Needs needs_of(const scene::Scene& scene, const RenderSettings& settings) {
  const auto asked = [&](image::Aov aov) {
    return std::find(settings.aovs.begin(), settings.aovs.end(), aov) != settings.aovs.end();
  };
  const bool lit = std::any_of(scene.lights.begin(), scene.lights.end(), may_shine);
  return {lit || !scene::is_black(scene.ambient), lit || asked(image::Aov::normal), asked(image::Aov::primitive)};
}

Result<void> load_attributes(LoadedObject& object, const Needs& needs, Skipped& skipped) {
  const nkd::ObjectFile& file = object.file;
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
  const scene::CameraAxes axes = scene::camera_axes(camera);
  const double pixel = 2 * axes.half_height / film.height;
  CameraView view;
  view.position = camera.position;
  view.right = axes.right * pixel;
  view.down = axes.up * -pixel;
  view.corner = axes.forward + view.right * (0.5 - 0.5 * film.width) + view.down * (0.5 - 0.5 * film.height);
  return view;
}

double cosine_of_degrees(double degrees) { return std::cos(degrees * std::numbers::pi / 180); }

LightView light_view(const scene::Light& light) {
  LightView view;
  view.colour = light.colour;
  view.is_point = light.kind != scene::LightKind::directional;
  view.vector = view.is_point ? light.position : -light.direction;
  if (!view.is_point) return view;
  view.inverse_square = light.falloff == scene::Falloff::inverse_square;
  view.inverse_reach = 1 / light.reach;
  if (light.kind == scene::LightKind::spot) {
    view.axis = light.direction;
    view.cos_outer = cosine_of_degrees(light.outer_degrees);
    const double width = cosine_of_degrees(light.inner_degrees) - view.cos_outer;
    view.inverse_width = width > 0 ? 1 / width : 1e300;
  }
  view.is_even = !view.inverse_square && view.inverse_reach == 0 && light.kind == scene::LightKind::point;
  return view;
}

/// Whether some instance is within the light's reach.
bool reaches(const scene::Light& light, std::span<const HierarchyNode> hierarchy) {
  if (light.kind == scene::LightKind::directional || hierarchy.empty()) return !hierarchy.empty();
  double squared = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = light.position[axis], lo = hierarchy[0].lo[axis], hi = hierarchy[0].hi[axis];
    const double off = at < lo ? lo - at : at > hi ? at - hi : 0;
    squared += off * off;
  }
  return std::sqrt(squared) <= light.reach;
}

/// All that depends on the frame but the instances.
Result<void> look_at_frame(LoadedScene& loaded, const scene::Scene& scene, double frame) {
  const auto camera = scene::camera_at(scene, frame);
  if (!camera) return camera.error();
  const auto lights = scene::lights_at(scene, frame);
  if (!lights) return lights.error();
  loaded.camera = camera_view(*camera, loaded.film);
  loaded.lights.clear();
  loaded.skipped.black_lights = loaded.skipped.lights_out_of_reach = 0;
  for (const scene::Light& light : *lights) {
    if (scene::is_black(light.colour)) {
      ++loaded.skipped.black_lights;
    } else if (!reaches(light, loaded.hierarchy)) {
      ++loaded.skipped.lights_out_of_reach;
    } else {
      loaded.lights.push_back(light_view(light));
    }
  }
  return {};
}

/// Of the objects that parts place, the others stay empty.
struct Headers {
  std::vector<std::optional<nkd::ObjectFile>> files;
  std::vector<Lattice> lattices;
};

Result<Headers> open_headers(const scene::Scene& scene, std::span<const scene::ObjectUse> uses) {
  Headers headers{std::vector<std::optional<nkd::ObjectFile>>(uses.size()), std::vector<Lattice>(uses.size())};
  for (size_t i = 0; i < uses.size(); ++i) {
    if (!uses[i].placed) continue;
    auto file = nkd::ObjectFile::open_header(scene.objects[i].file);
    if (!file) return file.error();
    if (file->geometry().form != VertexForm::lattice) {
      return Error{ErrorClass::object, scene.objects[i].file,
                   "its vertices are float32, for benchmarks only, and rendering is exact on the lattice: compile it "
                   "without --vertices float32"};
    }
    headers.lattices[i] = file->summary().lattice;
    headers.files[i] = std::move(*file);
  }
  return headers;
}

Result<void> place(LoadedScene& loaded, const scene::Scene& scene, std::span<const Lattice> lattices,
                   double first_frame) {
  const image::Window& w = loaded.window;
  const scene::FilmPart part{w.column, w.row, w.width, w.height};
  auto placed = loaded.frames.empty() ? scene::PlacedScene::place(scene, lattices, first_frame)
                                      : scene::PlacedScene::place_met(scene, lattices, part, loaded.frames);
  if (!placed) return placed.error();
  loaded.placed = std::move(*placed);
  loaded.instances = loaded.placed->instances();
  loaded.instance_numbers = loaded.placed->numbers();
  loaded.front_only = loaded.placed->front_only();
  loaded.hierarchy = loaded.placed->hierarchy();
  loaded.skipped.instances = loaded.placed->left_out();
  return {};
}

/// Of the objects whose headers are open, loads those that the instances need, and keeps what the headers say of all.
Result<void> load_objects(LoadedScene& loaded, Headers headers, std::span<const scene::ObjectUse> uses, Needs needs) {
  std::vector<bool> needed(uses.size(), loaded.frames.empty());
  for (const scene::Instance& instance : loaded.instances) needed[instance.object] = true;
  loaded.object_slots.assign(uses.size(), kNone);
  loaded.summaries.resize(uses.size());
  for (uint32_t i = 0; i < uses.size(); ++i) {
    if (!uses[i].placed) {
      ++loaded.skipped.objects;
      continue;
    }
    loaded.summaries[i] = headers.files[i]->summary();
    if (!needed[i]) {
      ++loaded.skipped.unmet_objects;
      continue;
    }
    loaded.object_slots[i] = static_cast<uint32_t>(loaded.objects.size());
    loaded.object_numbers.push_back(i);
    loaded.objects.push_back({std::move(*headers.files[i]), {}});
    Needs own = needs;
    own.materials = uses[i].own_materials && (needs.materials || loaded.summaries[i]->emissive);
    if (auto attributes = load_attributes(loaded.objects.back(), own, loaded.skipped); !attributes) return attributes;
  }
  std::vector<const nkd::ObjectFile*> files;
  for (const LoadedObject& object : loaded.objects) files.push_back(&object.file);
  loaded.checks.start(std::move(files));
  return {};
}

}  // namespace

Result<LoadedScene> load_scene(const scene::Scene& scene, const RenderSettings& settings,
                               std::span<const double> frames, Extent extent, Checking checking) {
  LoadedScene loaded;
  loaded.film = scene.film;
  loaded.window = settings.crop.value_or(image::Window{0, 0, scene.film.width, scene.film.height});
  if (extent == Extent::met) loaded.frames.assign(frames.begin(), frames.end());
  const std::vector<scene::ObjectUse> uses = scene::object_uses(scene);
  auto headers = open_headers(scene, uses);
  if (!headers) return headers.error();
  if (auto placed = place(loaded, scene, headers->lattices, frames.front()); !placed) return placed.error();
  auto objects = load_objects(loaded, std::move(*headers), uses, needs_of(scene, settings));
  if (!objects) return objects.error();

  loaded.overrides = scene::override_materials(scene);
  loaded.most_lights = static_cast<uint32_t>(scene.lights.size());
  loaded.moves = scene::key_range(scene).has_value();
  loaded.ambient = scene.ambient;
  loaded.background = scene.background;
  loaded.skipped.aov_buffers = static_cast<uint32_t>(image::kAovRows.size() - settings.aovs.size());
  if (auto looked = look_at_frame(loaded, scene, loaded.placed->frame()); !looked) return looked.error();
  if (checking == Checking::done) {
    if (auto sound = loaded.checks.all_sound(); !sound) return sound.error();
  }
  return loaded;
}

Result<Moved> move_to(LoadedScene& loaded, const scene::Scene& scene, double frame) {
  const std::vector<double>& frames = loaded.frames;
  if (!frames.empty() && std::find(frames.begin(), frames.end(), frame) == frames.end()) {
    return Error{ErrorClass::usage, scene.path, fmt::format("it was not loaded for frame {}", frame)};
  }
  const auto moved = loaded.placed->move_to(frame);
  if (!moved) return moved.error();
  if (auto looked = look_at_frame(loaded, scene, frame); !looked) return looked.error();
  return Moved{*moved};
}

InstanceView instance_view(const LoadedScene& scene, const scene::Instance& instance) {
  static_assert(kNone == scene::kOwnMaterials);
  return {instance.scene_to_lattice, instance.lattice_to_scene, scene.object_slots[instance.object], instance.material};
}

std::vector<InstanceView> instance_views(const LoadedScene& scene) {
  std::vector<InstanceView> views;
  views.reserve(scene.instances.size());
  for (const scene::Instance& instance : scene.instances) views.push_back(instance_view(scene, instance));
  return views;
}

}  // namespace kd::render
