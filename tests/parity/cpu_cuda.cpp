// The CPU and a GPU return the same bits: colour, preview and every AOV, over the scenes of data/ and the real meshes.
#include <cstring>

#include <doctest/doctest.h>

#include "support/workshop.h"

namespace {

using namespace kd;
using namespace kd::test;

template <class T>
size_t differing(const std::vector<T>& a, const std::vector<T>& b) {
  if (a.size() != b.size()) return std::max(a.size(), b.size());
  size_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) count += std::memcmp(&a[i], &b[i], sizeof(T)) != 0;
  return count;
}

void check_same(const std::string& name, const render::Frame& a, const render::Frame& b) {
  CHECK_MESSAGE(differing(a.film.colour, b.film.colour) == 0, name);
  CHECK_MESSAGE(differing(a.preview, b.preview) == 0, name);
  REQUIRE(a.film.aovs.size() == b.film.aovs.size());
  for (size_t i = 0; i < a.film.aovs.size(); ++i) {
    const std::string aov(image::aov_row(a.film.aovs[i].aov).name);
    CHECK_MESSAGE(differing(a.film.aovs[i].words, b.film.aovs[i].words) == 0, (name + " " + aov));
  }
  CHECK(a.stats.primary_hits == b.stats.primary_hits);
  CHECK(a.stats.shadow_rays == b.stats.shadow_rays);
}

void check_same(const std::string& name, const scene::Scene& scene, const render::Device& cpu,
                const render::Device& cuda) {
  const render::Frame a = render_all(scene, cpu), b = render_all(scene, cuda);
  check_same(name, a, b);
  check_same(name + ", compact", a, render_all(scene, cuda, TriangleLayout::compact));
  MESSAGE(name << ": the same in both layouts, " << a.film.width << " x " << a.film.height << ", "
               << a.stats.primary_hits << " hits, " << a.stats.shadow_rays << " shadow rays");
}

}  // namespace

TEST_CASE("a film's frames on CUDA, reached by motion, are those of the CPU alone") {
  const auto cuda = render::choose_device("cuda");
  if (!cuda) {
    MESSAGE("skipped: " << cuda.error().line());
    return;
  }
  Workshop workshop;
  for (const char* name : {"turntable.json", "walkthrough.json"}) {
    scene::Scene scene = workshop.data_scene(name);
    scene.film = {320, 180};
    render::RenderSettings settings;
    settings.samples = 3;
    const double frames[] = {1, 30, 77.5, 240, 2};
    auto loaded = render::load_scene(scene, settings, frames);
    REQUIRE(loaded);
    auto group = render::DeviceGroup::open({*cuda}, false, *loaded, settings);
    REQUIRE(group);
    for (const double& frame : std::span(frames).subspan(1)) {
      const auto moved = render::move_to(*loaded, scene, frame);
      REQUIRE(moved);
      REQUIRE(group->follow(*moved));
      const auto on_cuda = group->render({});
      REQUIRE(on_cuda);
      const auto alone = render::load_scene(scene, settings, {&frame, 1});
      const auto on_cpu = render::DeviceGroup::open({render::cpu_device()}, false, *alone, settings)->render({});
      CHECK_MESSAGE(differing(on_cuda->film.colour, on_cpu->film.colour) == 0,
                    (std::string(name) + " " + std::to_string(frame)));
      CHECK(on_cuda->stats.primary_hits > 1000);
    }
    MESSAGE(std::string(name) << ": the same, 4 frames of 3 samples");
  }
}

TEST_CASE("CPU and CUDA images are bit-identical") {
  auto cuda = render::choose_device("cuda");
  if (!cuda) {
    MESSAGE("skipped: " << cuda.error().line());
    return;
  }
  const auto cpu = render::choose_device("cpu");
  REQUIRE(cpu);
  Workshop workshop;
  for (const char* name : {"cathedral.json", "spheres.json", "turntable.json"})
    check_same(name, workshop.data_scene(name), *cpu, *cuda);
  scene::Scene one_sided = workshop.data_scene("cathedral.json");
  for (scene::Character& character : one_sided.characters) {
    for (size_t i = 0; i < character.parts.size(); i += 2) character.parts[i].sides = scene::Sides::front;
  }
  check_same("cathedral.json, fronts alone of every second part", one_sided, *cpu, *cuda);

  for (const char* name : kRealMeshes) {
    const auto mesh = shared_mesh(std::string(name) + ".ply");
    if (!mesh) {
      MESSAGE("skipped: no " << name << " in " << shared_data().string());
      continue;
    }
    const CameraFile camera = read_camera_file(shared_data() / "cameras" / (std::string(name) + ".txt"));
    check_same(name, object_scene(workshop.compile(*mesh), camera), *cpu, *cuda);
  }
}
