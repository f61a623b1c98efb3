#include "render/cpu_backend.h"

#include <array>
#include <atomic>

#include <fmt/format.h>

#include "render/expand.h"
#include "render/pipeline.h"
#include "render/stage_times.h"
#include "sys/parallel.h"
#include "sys/timer.h"

namespace kd::render {

namespace {

constexpr size_t kPixelGrain = 1024;

template <class T>
const T* data_or_null(std::span<const T> s) {
  return s.empty() ? nullptr : s.data();
}

/// The objects as the stages see them: sections where they are mapped, triangles expanded.
struct Objects {
  std::vector<HugeArray<TriangleVertices>> triangles;
  std::vector<ShadedObjectView> views;
  uint64_t bytes = 0;

  explicit Objects(const LoadedScene& scene) : triangles(scene.objects.size()), views(scene.objects.size()) {
    for (size_t i = 0; i < scene.objects.size(); ++i) {
      if (!scene.objects[i].file) continue;
      const nkd::ObjectFile& file = *scene.objects[i].file;
      const nkd::Attributes& a = scene.objects[i].attributes;
      const int bits = file.summary().lattice.bits;
      triangles[i] = expand_triangles(file.geometry());
      views[i] = {{file.geometry().nodes.data(), file.geometry().references.data(), triangles[i].data(), bits},
                  file.summary().lattice.step(),
                  data_or_null(a.source_primitives),
                  data_or_null(a.normals),
                  data_or_null(a.normal_indices),
                  data_or_null(a.materials),
                  data_or_null(a.material_ids)};
      bytes += file.geometry().nodes.size_bytes() + file.geometry().references.size_bytes() +
               triangles[i].size() * sizeof(TriangleVertices) + a.source_primitives.size_bytes() +
               a.normals.size_bytes() + a.normal_indices.size_bytes() + a.materials.size_bytes() +
               a.material_ids.size_bytes();
    }
  }
};

/// stage(pixel) for every pixel; returns the sum of what the calls return. Ends early once `progress` is cancelled.
template <class Stage>
uint64_t for_each_pixel(const Stage& stage, size_t pixels, SharedProgress& progress, double share) {
  std::atomic<uint64_t> total = 0;
  parallel_ranges(pixels, kPixelGrain, [&](size_t begin, size_t end) {
    if (!progress.keep_going(share)) return;
    uint64_t count = 0;
    for (size_t pixel = begin; pixel < end; ++pixel) count += stage(static_cast<uint32_t>(pixel));
    total += count;
  });
  return total;
}

}  // namespace

Result<std::string> cpu_probe(int) { return fmt::format("CPU: {} threads", thread_count()); }

Result<Frame> cpu_render(const LoadedScene& scene, const RenderSettings& settings, int) {
  Frame out;
  Timer timer;
  const Objects objects(scene);
  const std::vector<InstanceView> instances = instance_views(scene);
  out.stats.upload_seconds = timer.lap();
  out.stats.object_bytes = objects.bytes;

  const size_t pixels = size_t{scene.film.width} * scene.film.height;
  std::vector<SurfaceHit> hits(pixels);
  out.film.width = scene.film.width;
  out.film.height = scene.film.height;
  out.film.colour.resize(4 * pixels);
  if (settings.preview) out.preview.resize(3 * pixels);
  std::vector<AovTarget> targets;
  for (image::Aov aov : settings.aovs) {
    out.film.aovs.push_back({aov, std::vector<uint32_t>(static_cast<size_t>(image::aov_row(aov).components) * pixels)});
  }
  out.stats.frame_bytes = pixels * (sizeof(SurfaceHit) + sizeof(Pixel)) + out.preview.size();
  for (image::AovBuffer& buffer : out.film.aovs) {
    targets.push_back({buffer.aov, buffer.words.data()});
    out.stats.frame_bytes += buffer.words.size() * sizeof(uint32_t);
  }

  FrameView frame;
  frame.scene = {scene.hierarchy.data(), instances.data(),    objects.views.data(),
                 scene.overrides.data(), scene.lights.data(), static_cast<uint32_t>(instances.size()),
                 scene.ambient,          scene.background};
  frame.camera = scene.camera;
  frame.width = scene.film.width;
  frame.height = scene.film.height;
  frame.hits = hits.data();
  frame.colour = reinterpret_cast<Pixel*>(out.film.colour.data());
  frame.preview = out.preview.data();
  frame.inverse_gamma = 1 / settings.gamma;

  const PipelinePlan plan{static_cast<uint32_t>(scene.lights.size()), targets, settings.preview,
                          settings.gamma_on_film};
  SharedProgress progress(settings.progress);
  size_t launched = 0;
  std::array<uint64_t, kCounters + 1> totals{};  // the last: of stages that count nothing
  const auto launch = [&](const auto& stage) {
    Timer stage_timer;
    const double share = static_cast<double>(launched++) / static_cast<double>(plan.launches());
    const uint64_t count = for_each_pixel(stage, pixels, progress, share);
    add_stage_time(out.stats, stage.kName, stage_timer.seconds());
    totals[kCounter<std::decay_t<decltype(stage)>>] += count;
    return count;
  };
  Timer whole;
  for (int warm_ups = settings.warm_ups; warm_ups >= 0; --warm_ups) {
    out.stats.stages.clear();
    totals.fill(0);
    launched = 0;
    whole.lap();
    run_pipeline(frame, plan, launch, launch);
  }
  if (progress.cancelled()) return Error{ErrorClass::interrupted, "", "interrupted"};
  out.stats.render_seconds = whole.seconds();
  out.stats.primary_rays = pixels;
  out.stats.primary_hits = totals[kHits];
  out.stats.shadow_rays = totals[kShadowRays];
  return out;
}

}  // namespace kd::render
