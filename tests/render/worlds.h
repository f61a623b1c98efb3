// Objects as files and scenes of them, for rendering in tests.
#pragma once

#include <bit>
#include <string>
#include <utility>
#include <vector>

#include "../nkd/object_bytes.h"
#include "render/device_group.h"
#include "render/load.h"

namespace kd::test {

/// The cube [0, 1]^3 in model space, 12 triangles, without attributes.
inline Contents unit_cube(int bits = 21) {
  const uint32_t top = lattice_max(bits);
  Contents c(box_shape({0, 0, 0}, {top, top, top}), bits, false);
  c.summary.lattice = {{0, 0, 0}, {1, 1, 1}, bits};
  c.count_tree();
  return c;
}

inline scene::Part part(uint32_t object, scene::Placement placement) {
  scene::Part p;
  p.object = object;
  p.placement = std::move(placement);
  return p;
}

inline scene::TransformPlacement moved(Vec3d translate, Vec3d scale = {1, 1, 1}) {
  scene::TransformPlacement t;
  t.translate = translate;
  t.scale = scale;
  return t;
}

/// A scene of the given objects and parts, seen along -z from (0.5, 0.5, 5).
inline scene::Scene scene_of(std::vector<std::string> files, std::vector<scene::Part> parts, uint32_t size = 33) {
  scene::Scene s;
  s.path = "test.json";
  s.film = {size, size};
  s.camera = {{0.5, 0.5, 5}, {0.5, 0.5, 0}, {0, 1, 0}, 30};
  for (size_t i = 0; i < files.size(); ++i) s.objects.push_back({"object " + std::to_string(i), files[i]});
  s.characters.push_back({"all", std::move(parts)});
  return s;
}

/// All AOVs.
inline render::RenderSettings all_aovs() {
  render::RenderSettings settings;
  for (const image::AovRow& row : image::kAovRows) settings.aovs.push_back(row.aov);
  return settings;
}

/// A scene loaded and rendered on the CPU; an error throws, for the test to fail.
struct Rendered {
  render::LoadedScene scene;
  render::Frame frame;

  Rendered(const scene::Scene& s, const render::RenderSettings& settings)
      : scene(*render::load_scene(s, settings)),
        frame(*render::DeviceGroup::open({render::cpu_device()}, false, scene, settings)->render({})) {}

  const std::vector<uint32_t>& words(image::Aov aov) const {
    for (const image::AovBuffer& b : frame.film.aovs) {
      if (b.aov == aov) return b.words;
    }
    static const std::vector<uint32_t> none;
    return none;
  }
  float number(image::Aov aov, size_t index) const { return std::bit_cast<float>(words(aov)[index]); }
  size_t centre() const { return size_t{scene.film.height / 2} * scene.film.width + scene.film.width / 2; }
  Vec3f colour(size_t pixel) const {
    const float* c = &frame.film.colour[4 * pixel];
    return {c[0], c[1], c[2]};
  }
};

inline bool same_film(const image::Film& a, const image::Film& b) {
  if (a.colour != b.colour || a.aovs.size() != b.aovs.size()) return false;
  for (size_t i = 0; i < a.aovs.size(); ++i) {
    if (a.aovs[i].words != b.aovs[i].words) return false;
  }
  return true;
}

}  // namespace kd::test
