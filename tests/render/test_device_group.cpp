// Devices that share a frame: the same picture however it is divided, and what happens when one of them fails.
#include <atomic>

#include <doctest/doctest.h>

#include "worlds.h"

using namespace kd;
using namespace kd::test;
using render::DeviceGroup;

namespace {

/// The CPU behind a renderer that holds few rows, or fails at one of its strips.
struct Plan {
  uint32_t max_rows = 1000;
  int fails_at_strip = -1;
  std::optional<ErrorClass> fails_to_open;
  std::atomic<int> strips = 0;
};
Plan plans[2];

class FakeRenderer final : public render::Renderer {
 public:
  FakeRenderer(std::unique_ptr<Renderer> cpu, Plan& plan) : cpu_(std::move(cpu)), plan_(plan) {}
  uint32_t max_rows() const override { return plan_.max_rows; }
  const render::Holding& holding() const override { return cpu_->holding(); }
  Result<void> follow(const render::Moved& moved) override { return cpu_->follow(moved); }
  Result<render::RenderStats> render(render::Strip strip, render::Frame& frame, const Progress& progress) override {
    CHECK(strip.rows <= plan_.max_rows);
    if (plan_.strips++ == plan_.fails_at_strip) return Error{ErrorClass::device, "", "CUDA: rendering: lost"};
    return cpu_->render(strip, frame, progress);
  }

 private:
  std::unique_ptr<Renderer> cpu_;
  Plan& plan_;
};

Result<std::unique_ptr<render::Renderer>> open_fake(const render::LoadedScene& scene,
                                                    const render::RenderSettings& settings, int index) {
  Plan& plan = plans[index];
  if (plan.fails_to_open) return Error{*plan.fails_to_open, "", "CUDA: allocating: out of memory"};
  auto cpu = render::cpu_device().backend->open(scene, settings, 0);
  return std::unique_ptr<render::Renderer>(std::make_unique<FakeRenderer>(std::move(*cpu), plan));
}

const render::Backend kFake{"fake", nullptr, nullptr, open_fake, nullptr};

/// Plans for this many devices, all well.
std::vector<render::Device> fakes(int count) {
  std::vector<render::Device> devices;
  for (int i = 0; i < count; ++i) {
    plans[i].max_rows = 1000;
    plans[i].fails_at_strip = -1;
    plans[i].fails_to_open.reset();
    plans[i].strips = 0;
    devices.push_back({&kFake, i, "fake " + std::to_string(i), ""});
  }
  return devices;
}

struct World {
  TempFolder folder;
  render::RenderSettings settings = all_aovs();
  render::LoadedScene scene;

  explicit World(uint32_t size) : scene(load(size)) {}

  render::LoadedScene load(uint32_t size) {
    auto s = scene_of({unit_cube().write(folder.file("cube.nkd"))}, {part(0, moved({}))}, size);
    s.lights.push_back({});
    s.lights[0].position = {3, 4, 5};
    settings.preview = true;
    return *render::load_scene(s, settings);
  }
};

}  // namespace

TEST_CASE("device group: strips of any size make the same frame") {
  const World world(301);
  const auto whole = DeviceGroup::open({render::cpu_device()}, false, world.scene, world.settings)->render({});
  REQUIRE(whole);
  const auto check_same = [&](DeviceGroup& group, uint32_t least_strips) {
    const auto frame = group.render({});
    REQUIRE(frame);
    CHECK(group.strips() >= least_strips);
    CHECK(same_film(frame->film, whole->film));
    CHECK(frame->preview == whole->preview);
    CHECK(frame->stats.primary_rays == whole->stats.primary_rays);
    CHECK(frame->stats.primary_hits == whole->stats.primary_hits);
    CHECK(frame->stats.shadow_rays == whole->stats.shadow_rays);
  };
  auto devices = fakes(1);
  plans[0].max_rows = 7;
  auto short_of_memory = DeviceGroup::open(devices, false, world.scene, world.settings);
  check_same(*short_of_memory, 43);
  auto two = DeviceGroup::open(fakes(2), false, world.scene, world.settings);
  check_same(*two, 2);
  check_same(*two, 2);
  CHECK(two->holding().object_bytes == 2 * short_of_memory->holding().object_bytes);
}

TEST_CASE("device group: a device that fails is an error, or the CPU takes over and says so") {
  const World world(65);
  const auto whole = DeviceGroup::open({render::cpu_device()}, false, world.scene, world.settings)->render({});
  auto devices = fakes(1);
  plans[0].max_rows = 16;
  plans[0].fails_at_strip = 2;
  auto strict = DeviceGroup::open(devices, false, world.scene, world.settings);
  const auto failed = strict->render({});
  REQUIRE_FALSE(failed);
  CHECK(failed.error().error_class == ErrorClass::device);
  CHECK(failed.error().line() == "CUDA: rendering: lost");

  plans[0].strips = 0;
  auto lenient = DeviceGroup::open(devices, true, world.scene, world.settings);
  CHECK(lenient->taken_over().empty());
  const auto frame = lenient->render({});
  REQUIRE(frame);
  CHECK(same_film(frame->film, whole->film));
  CHECK(lenient->taken_over() == "CUDA: rendering: lost");
  CHECK(lenient->devices().front().description == render::cpu_device().description);

  for (ErrorClass why : {ErrorClass::resource, ErrorClass::device}) {
    devices = fakes(1);
    plans[0].fails_to_open = why;
    const auto refused = DeviceGroup::open(devices, false, world.scene, world.settings);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().line() == "fake 0: CUDA: allocating: out of memory");
    auto taken_over = DeviceGroup::open(devices, true, world.scene, world.settings);
    REQUIRE(taken_over);
    CHECK(taken_over->taken_over() == refused.error().line());
    CHECK(same_film(taken_over->render({})->film, whole->film));
  }
}

TEST_CASE("device group: one of two that fails stops the other, and nobody takes over for what was cancelled") {
  const World world(301);
  auto devices = fakes(2);
  plans[1].fails_at_strip = 0;
  plans[0].max_rows = 1;
  auto two = DeviceGroup::open(devices, false, world.scene, world.settings);
  const auto failed = two->render({});
  REQUIRE_FALSE(failed);
  CHECK(failed.error().error_class == ErrorClass::device);

  auto group = DeviceGroup::open(fakes(2), true, world.scene, world.settings);
  const auto cancelled = group->render([](double) { return false; });
  REQUIRE_FALSE(cancelled);
  CHECK(cancelled.error().error_class == ErrorClass::interrupted);
  CHECK(group->taken_over().empty());
}

TEST_CASE("device group: progress grows to the whole frame") {
  const World world(129);
  auto devices = fakes(1);
  plans[0].max_rows = 16;
  auto group = DeviceGroup::open(devices, false, world.scene, world.settings);
  double last = 0;
  REQUIRE(group->render([&](double share) {
    CHECK(share >= last);
    CHECK(share <= 1);
    last = share;
    return true;
  }));
  CHECK(last > 0.8);
}

TEST_CASE("devices are chosen by name") {
  const auto cpu = render::choose_devices("cpu");
  REQUIRE(cpu);
  CHECK(cpu->size() == 1);
  CHECK(cpu->front().description == render::cpu_device().description);
  CHECK(render::choose_devices("auto"));
  for (const char* bad : {"", "gpu", "cpu:0", "cuda:x", "cuda:-1", "cuda:", "auto,cpu", "cpu,", "cpu,cpu", ",cpu"}) {
    const auto none = render::choose_devices(bad);
    REQUIRE_FALSE_MESSAGE(none, bad);
    CHECK_MESSAGE(none.error().error_class == ErrorClass::usage, bad);
  }
}
