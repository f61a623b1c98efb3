// What a GPU does when memory is short, and when several share a frame: strips, an error that says what was needed, or
// the CPU; never another picture.
#include <doctest/doctest.h>

#include "support/workshop.h"

#if KD_WITH_CUDA
#include <cuda_runtime.h>

namespace {

using namespace kd;
using namespace kd::test;

/// Takes all of the first device's memory but `left` bytes while it lives.
class MemoryHog {
 public:
  explicit MemoryHog(size_t left) {
    size_t free = 0, total = 0;
    REQUIRE(cudaMemGetInfo(&free, &total) == cudaSuccess);
    // What is left is in pieces, and what the driver keeps for itself varies: in small bites down to the mark.
    for (size_t bite = size_t{1} << 30; bite >= size_t{1} << 20; bite /= 2) {
      while (free > left + bite) {
        void* piece = nullptr;
        if (cudaMalloc(&piece, bite) != cudaSuccess) {
          cudaGetLastError();
          break;
        }
        pieces_.push_back(piece);
        cudaMemGetInfo(&free, &total);
      }
    }
  }
  ~MemoryHog() {
    for (void* piece : pieces_) cudaFree(piece);
  }

 private:
  std::vector<void*> pieces_;
};

bool same(const render::Frame& a, const render::Frame& b) {
  if (a.film.colour != b.film.colour || a.preview != b.preview) return false;
  for (size_t i = 0; i < a.film.aovs.size(); ++i) {
    if (a.film.aovs[i].words != b.film.aovs[i].words) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("a GPU that is short of memory") {
  const auto cuda = render::choose_device("cuda");
  if (!cuda) {
    MESSAGE("skipped: " << cuda.error().line());
    return;
  }
  Workshop workshop;
  scene::Scene scene = workshop.data_scene("cathedral.json");
  scene.film = {2048, 2048};
  render::RenderSettings settings;
  for (const image::AovRow& row : image::kAovRows) settings.aovs.push_back(row.aov);
  settings.preview = true;
  const auto loaded = render::load_scene(scene, settings);
  REQUIRE(loaded);
  const auto render_on = [&](std::vector<render::Device> devices, bool cpu_may_take_over) {
    return render::DeviceGroup::open(std::move(devices), cpu_may_take_over, *loaded, settings);
  };
  auto roomy = render_on({*cuda}, false);
  REQUIRE(roomy);
  const auto whole = roomy->render({});
  REQUIRE(whole);
  CHECK(roomy->strips() == 1);

  {  // The same device twice: as on a machine with two.
    auto two = render_on({*cuda, *cuda}, false);
    REQUIRE(two);
    CHECK(same(*two->render({}), *whole));
    MESSAGE("two renderers: " << two->strips() << " strips, the same frame");
    CHECK(two->strips() > 1);
  }
  CHECK(roomy->holding().layout == TriangleLayout::expanded);
  roomy = Error{};  // gives its memory back
  {
    const MemoryHog hog(64 << 20);
    auto tight = render_on({*cuda}, false);
    REQUIRE_MESSAGE(tight, (tight ? "" : tight.error().line()));
    CHECK(same(*tight->render({}), *whole));
    MESSAGE("64 MiB left: " << tight->strips() << " strips, the same frame");
    CHECK(tight->strips() > 1);
  }
  {
    const MemoryHog hog(1 << 20);
    const auto none = render_on({*cuda}, false);
    REQUIRE_FALSE(none);
    MESSAGE(none.error().line());
    CHECK(none.error().error_class == ErrorClass::resource);
    CHECK(none.error().line().find("MiB needed (") != std::string::npos);
    auto taken_over = render_on({*cuda}, true);
    REQUIRE(taken_over);
    CHECK(same(*taken_over->render({}), *whole));
    CHECK(taken_over->taken_over() == none.error().line());
  }
}

TEST_CASE("a GPU that has no memory for expanded triangles") {
  const auto cuda = render::choose_device("cuda");
  if (!cuda) {
    MESSAGE("skipped: " << cuda.error().line());
    return;
  }
  const auto mesh = shared_mesh("staircase.ply");
  if (!mesh) {
    MESSAGE("skipped: no staircase in " << shared_data().string());
    return;
  }
  Workshop workshop;
  const scene::Scene scene =
      object_scene(workshop.compile(*mesh), read_camera_file(shared_data() / "cameras" / "staircase.txt"));
  const render::RenderSettings settings;
  const auto loaded = render::load_scene(scene, settings);
  REQUIRE(loaded);
  const auto frame_on = [&](TriangleLayout layout) {
    auto group = render::DeviceGroup::open({*cuda}, false, *loaded, settings);
    REQUIRE_MESSAGE(group, (group ? "" : group.error().line()));
    CHECK(group->holding().layout == layout);
    return *group->render({});
  };
  const render::Frame expanded = frame_on(TriangleLayout::expanded);  // 18 MiB of objects
  const MemoryHog hog(16 << 20);
  CHECK(same(frame_on(TriangleLayout::compact), expanded));  // 10 MiB, and 4 while it is made
  MESSAGE("16 MiB left: compact, the same frame");
}
#endif
