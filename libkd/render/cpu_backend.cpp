#include "render/cpu_backend.h"

#include <array>
#include <atomic>
#include <memory>

#include <fmt/format.h>

#include "render/expand.h"
#include "render/packet_stages.h"
#include "render/strip.h"
#include "render/tiles.h"
#include "sys/parallel.h"
#include "sys/timer.h"

namespace kd::render {

namespace {

constexpr size_t kPixelGrain = 1024;

/// Runs a stage for every pixel of a strip, in packets where it traces rays; returns the sum of what its calls return.
/// Ends early once `progress` is cancelled.
template <class Stage>
uint64_t run_stage(const Stage& stage, uint32_t width, uint32_t height, SharedProgress& progress, double share) {
  std::atomic<uint64_t> total = 0;
  if constexpr (requires(PerRay<uint32_t> pixels) { run_packet(stage, pixels, kNoRays); }) {
    const Tiles tiles(width, height);
    parallel_ranges(tiles.count(), 1, [&](size_t begin, size_t end) {
      uint64_t count = 0;
      for (size_t tile = begin; tile < end && progress.keep_going(share); ++tile) {
        tiles.for_each_packet(
            tile, [&](const PerRay<uint32_t>& pixels, RaySet set) { count += run_packet(stage, pixels, set); });
      }
      total += count;
    });
  } else {
    parallel_ranges(size_t{width} * height, kPixelGrain, [&](size_t begin, size_t end) {
      if (!progress.keep_going(share)) return;
      uint64_t count = 0;
      for (size_t pixel = begin; pixel < end; ++pixel) count += stage(static_cast<uint32_t>(pixel));
      total += count;
    });
  }
  return total;
}

TriangleLayout layout_of(const RenderSettings& settings) { return settings.layout.value_or(TriangleLayout::expanded); }

class CpuRenderer final : public Renderer {
 public:
  CpuRenderer(const LoadedScene& scene, const RenderSettings& settings, const Timer& opening)
      : scene_(scene), settings_(settings), objects_(scene, layout_of(settings)), instances_(instance_views(scene)) {
    holding_.upload_seconds = opening.seconds();
    holding_.object_bytes = object_bytes(scene, layout_of(settings));
    holding_.layout = layout_of(settings);
    holding_.scene_bytes = instances_.size() * sizeof(InstanceView) + scene.hierarchy.size() * sizeof(HierarchyNode) +
                           scene.lights.size() * sizeof(LightView);
    holding_.strip_bytes = size_t{scene.window.width} * scene.window.height * bytes_a_pixel(settings);
  }

  uint32_t max_rows() const override { return scene_.window.height; }
  const Holding& holding() const override { return holding_; }
  Result<void> follow(const Moved& moved) override {
    for (uint32_t i : moved.instances) instances_[i] = instance_view(scene_, scene_.instances[i]);
    return {};
  }
  Result<RenderStats> render(Strip strip, Frame& frame, const Progress& progress) override;

 private:
  const LoadedScene& scene_;
  RenderSettings settings_;
  HostObjects objects_;
  std::vector<InstanceView> instances_;
  std::vector<SurfaceHit> hits_;
  Holding holding_;
};

Result<RenderStats> CpuRenderer::render(Strip strip, Frame& frame, const Progress& progress) {
  const size_t width = scene_.window.width, pixels = width * strip.rows, first = width * strip.first_row;
  hits_.resize(std::max(hits_.size(), pixels));
  std::vector<AovTarget> targets;
  for (image::AovBuffer& buffer : frame.film.aovs) {
    const auto components = static_cast<size_t>(image::aov_row(buffer.aov).components);
    targets.push_back({buffer.aov, buffer.words.data() + components * first});
  }
  FrameView view = strip_view(scene_, settings_, strip);
  view.scene.layout = holding_.layout;
  view.scene.hierarchy = scene_.hierarchy.data();
  view.scene.instances = instances_.data();
  view.scene.objects = objects_.views.data();
  view.scene.overrides = scene_.overrides.data();
  view.scene.lights = scene_.lights.data();
  view.scene.front_only = scene_.front_only.empty() ? nullptr : scene_.front_only.data();
  view.scene.instance_numbers = scene_.instance_numbers.empty() ? nullptr : scene_.instance_numbers.data();
  view.scene.object_numbers = scene_.object_numbers.data();
  view.hits = hits_.data();
  view.colour = reinterpret_cast<Pixel*>(frame.film.colour.data()) + first;
  view.preview = frame.preview.empty() ? nullptr : frame.preview.data() + 3 * first;

  const PipelinePlan plan = pipeline_plan(scene_, settings_, targets);
  RenderStats stats;
  SharedProgress shared(progress);
  size_t launched = 0;
  std::array<uint64_t, kCounters + 1> totals{};  // the last: of stages that count nothing
  const auto launch = [&](const auto& stage) {
    Timer stage_timer;
    const double share = static_cast<double>(launched++) / static_cast<double>(plan.launches());
    const uint64_t count = run_stage(stage, view.width, view.height, shared, share);
    stats.add_stage(stage.kName, stage_timer.seconds());
    return (totals[kCounter<std::decay_t<decltype(stage)>>] += count) > 0;
  };
  Timer whole;
  run_pipeline(view, plan, launch, launch);
  if (shared.cancelled()) return Error{ErrorClass::interrupted, "", "interrupted"};
  stats.render_seconds = whole.seconds();
  stats.primary_rays = pixels * plan.primary_rays();
  stats.primary_hits = totals[kHits];
  stats.shadow_rays = totals[kShadowRays];
  return stats;
}

}  // namespace

Result<int> cpu_count() { return 1; }

Result<std::string> cpu_probe(int) { return fmt::format("CPU: {} threads", thread_count()); }

Result<std::unique_ptr<Renderer>> cpu_open(const LoadedScene& scene, const RenderSettings& settings, int) {
  const Timer opening;
  if (auto sound = scene.checks.all_sound(); !sound) return sound.error();
  return std::unique_ptr<Renderer>(std::make_unique<CpuRenderer>(scene, settings, opening));
}

}  // namespace kd::render
