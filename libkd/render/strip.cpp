#include "render/strip.h"

#include "render/expand.h"

namespace kd::render {

FrameView strip_view(const LoadedScene& scene, const RenderSettings& settings, Strip strip) {
  FrameView view;
  view.scene.instance_count = static_cast<uint32_t>(scene.instances.size());
  view.scene.ambient = scene.ambient;
  view.scene.background = scene.background;
  view.camera = scene.camera;
  view.width = scene.window.width;
  view.height = strip.rows;
  view.first_column = scene.window.column;
  view.first_row = scene.window.row + strip.first_row;
  view.inverse_gamma = 1 / settings.gamma;
  return view;
}

PipelinePlan pipeline_plan(const LoadedScene& scene, const RenderSettings& settings, std::span<const AovTarget> aovs) {
  return {static_cast<uint32_t>(scene.lights.size()),
          settings.samples,
          aovs,
          settings.preview,
          settings.gamma_on_film,
          scene.is_one_instance(),
          !scene.front_only.empty()};
}

size_t bytes_a_pixel(const RenderSettings& settings) {
  size_t bytes = sizeof(SurfaceHit) + sizeof(Pixel) + (settings.preview ? 3 : 0);
  for (image::Aov aov : settings.aovs) bytes += static_cast<size_t>(image::aov_row(aov).components) * sizeof(uint32_t);
  return bytes;
}

uint64_t object_bytes(const LoadedScene& scene, TriangleLayout layout) {
  uint64_t bytes = 0;
  for (const LoadedObject& object : scene.objects) {
    const nkd::Attributes& a = object.attributes;
    bytes += traversal_bytes(object.file.geometry(), layout) + a.source_primitives.size_bytes() +
             a.normals.size_bytes() + a.normal_indices.size_bytes() + a.materials.size_bytes() +
             a.material_ids.size_bytes();
  }
  return bytes;
}

Frame blank_frame(const LoadedScene& scene, const RenderSettings& settings) {
  const image::Window& window = scene.window;
  const size_t pixels = size_t{window.width} * window.height;
  Frame frame;
  frame.film = {window.width, window.height, window.column, window.row, scene.film.width, scene.film.height, {}, {}};
  frame.film.colour.resize(4 * pixels);
  if (settings.preview) frame.preview.resize(3 * pixels);
  for (image::Aov aov : settings.aovs) {
    const auto components = static_cast<size_t>(image::aov_row(aov).components);
    frame.film.aovs.push_back({aov, std::vector<uint32_t>(components * pixels)});
  }
  return frame;
}

}  // namespace kd::render
