#include "paper/run.h"
#include "render/expand.h"
#include "render/strip.h"
#include "sys/parallel.h"
#include "sys/timer.h"

namespace kd::bench::paper {

namespace {

constexpr size_t kPixelGrain = 1024;

template <class Stage>
void for_each_element(const Stage& stage, uint32_t pixels, uint32_t planes) {
  parallel_ranges(uint64_t{pixels} * planes, kPixelGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) stage(static_cast<uint32_t>(i % pixels), static_cast<uint32_t>(i / pixels));
  });
}

}  // namespace

Result<Run> run_on_cpu(const render::LoadedScene& scene, const render::RenderSettings& settings, const Job& job) {
  const render::HostObjects objects(scene, TriangleLayout::expanded);
  const std::vector<render::InstanceView> instances = instance_views(scene);
  const size_t pixels = size_t{scene.film.width} * scene.film.height;
  Run out;
  out.film.resize(4 * pixels);
  HugeArray<SurfaceHit> hits(pixels);
  FrameView frame = render::strip_view(scene, settings, {0, scene.film.height});
  frame.scene.hierarchy = scene.hierarchy.data();
  frame.scene.instances = instances.data();
  frame.scene.objects = objects.views.data();
  frame.scene.overrides = scene.overrides.data();
  frame.scene.lights = scene.lights.data();
  frame.hits = hits.data();
  frame.colour = reinterpret_cast<render::Pixel*>(out.film.data());

  const auto lights = static_cast<uint32_t>(scene.lights.size());
  auto division = divide(frame, lights, job, out);
  if (!division) return division.error();
  const Buffers& buffers = division->buffers;
  HugeArray<Ray> rays(buffers.rays), shadow_rays(buffers.shadow_rays);
  HugeArray<SurfaceHit> intersections(buffers.intersections);
  HugeArray<uint8_t> occluded(buffers.shadow_tests);
  const StripView strip{frame, 0, 0, rays.data(), intersections.data(), shadow_rays.data(), occluded.data()};
  for (int i = -job.warm_ups; i < job.repeats; ++i) {
    if (!keep_going(job.progress, 0)) return Error{ErrorClass::interrupted, "", "interrupted"};
    render::RenderStats stats;
    const Timer whole;
    run_film(job.form, strip, division->rows, lights, settings.gamma_on_film, [&](const auto& stage, uint32_t planes) {
      const Timer timer;
      for_each_element(stage, stage.strip.pixels, planes);
      stats.add_stage(stage.kName, timer.seconds());
    });
    stats.render_seconds = whole.seconds();
    if (i >= 0) out.frames.push_back(std::move(stats));
  }
  return out;
}

}  // namespace kd::bench::paper
