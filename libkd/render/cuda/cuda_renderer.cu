// A scene on a CUDA device and the buffers of a strip; renders as many strips as it is asked for.
#include <algorithm>
#include <deque>
#include <optional>

#include "render/cuda/cuda_backend.h"
#include "render/cuda/device_scene.h"
#include "render/cuda/stage_kernel.h"
#include "render/strip.h"
#include "sys/timer.h"

namespace kd::render {

namespace {

/// The buffers of a strip. `lay_out` runs twice: once to add up sizes, once to hand out addresses.
class StripBuffers {
 public:
  /// For `rows` rows, or as many as there is memory for.
  Result<void> create(const LoadedScene& scene, const RenderSettings& settings);
  uint32_t rows() const { return rows_; }
  size_t bytes() const { return memory_.bytes(); }
  void set(FrameView& view) const {
    view.hits = hits_;
    view.colour = colour_;
    view.preview = preview_;
  }
  std::span<const AovTarget> targets() const { return targets_; }
  unsigned long long* totals() const { return totals_; }

 private:
  void lay_out(size_t pixels, const RenderSettings& settings);

  DeviceMemory memory_;
  uint32_t rows_ = 0;
  SurfaceHit* hits_ = nullptr;
  Pixel* colour_ = nullptr;
  uint8_t* preview_ = nullptr;
  std::vector<AovTarget> targets_;
  unsigned long long* totals_ = nullptr;
};

void StripBuffers::lay_out(size_t pixels, const RenderSettings& settings) {
  memory_.section("hits");
  hits_ = memory_.piece<SurfaceHit>(pixels);
  memory_.section("film");
  colour_ = memory_.piece<Pixel>(pixels);
  preview_ = memory_.piece<uint8_t>(settings.preview ? 3 * pixels : 0);
  totals_ = memory_.piece<unsigned long long>(kCounters);
  memory_.section("AOVs");
  targets_.clear();
  for (image::Aov aov : settings.aovs) {
    const auto components = static_cast<size_t>(image::aov_row(aov).components);
    targets_.push_back({aov, memory_.piece<uint32_t>(components * pixels)});
  }
}

Result<void> StripBuffers::create(const LoadedScene& scene, const RenderSettings& settings) {
  constexpr uint32_t kTileRows = 4;  // of a warp's pixels
  for (rows_ = scene.window.height;; rows_ = (rows_ / 2 + kTileRows - 1) / kTileRows * kTileRows) {
    const size_t pixels = size_t{scene.window.width} * rows_;
    lay_out(pixels, settings);
    const auto allocated = memory_.allocate();
    if (allocated) {
      lay_out(pixels, settings);
      return {};
    }
    if (allocated.error().error_class != ErrorClass::resource || rows_ <= kTileRows) return allocated;
  }
}

class CudaRenderer final : public Renderer {
 public:
  CudaRenderer(const LoadedScene& scene, const RenderSettings& settings, int index)
      : scene_(scene), settings_(settings), index_(index) {}

  Result<void> open();
  uint32_t max_rows() const override { return buffers_.rows(); }
  const Holding& holding() const override { return holding_; }
  Result<void> follow(const Moved& moved) override {
    KD_CUDA_TRY(cudaSetDevice(index_), "choosing the device");
    return device_scene_.follow(scene_, moved, stream_);
  }
  Result<RenderStats> render(Strip strip, Frame& frame, const Progress& progress) override;

 private:
  /// In the settings' layout, or the first one that there is memory for.
  Result<void> upload_scene();
  Result<void> upload_in(TriangleLayout layout);
  /// Loads the kernels that a frame will launch: the driver would at their first launch, and hold up the frame.
  void load_kernels() const;
  Result<RenderStats> run_stages(const FrameView& view, const Progress& progress);
  Result<void> download_strip(const FrameView& view, Strip strip, Frame& frame);

  const LoadedScene& scene_;
  RenderSettings settings_;
  int index_;
  Stream stream_;
  DeviceScene device_scene_;
  StripBuffers buffers_;
  HostFlag hit_seen_;
  Holding holding_;
};

Result<void> CudaRenderer::upload_scene() {
  const auto uploaded = upload_in(settings_.layout.value_or(TriangleLayout::expanded));
  const bool short_of_memory = !uploaded && uploaded.error().error_class == ErrorClass::resource;
  return short_of_memory && !settings_.layout ? upload_in(TriangleLayout::compact) : uploaded;
}

Result<void> CudaRenderer::upload_in(TriangleLayout layout) {
  holding_.layout = layout;
  if (auto created = device_scene_.create(scene_, layout, stream_); !created) return created;
  return buffers_.create(scene_, settings_);
}

void CudaRenderer::load_kernels() const {
  PipelinePlan plan = pipeline_plan(scene_, settings_, buffers_.targets());
  plan.samples = min_of(plan.samples, 2u);
  const auto load_kernel = [](const auto& stage) {
    cudaFuncAttributes attributes;
    cudaFuncGetAttributes(&attributes, stage_kernel<std::decay_t<decltype(stage)>>);
    return true;
  };
  FrameView view = strip_view(scene_, settings_, {0, scene_.window.height});
  view.scene.layout = holding_.layout;
  run_pipeline(view, plan, load_kernel, load_kernel);
  cudaGetLastError();  // what cannot be loaded fails when it is launched, and says so there
}

Result<void> CudaRenderer::open() {
  Timer timer;
  KD_CUDA_TRY(cudaSetDevice(index_), "choosing the device");
  KD_CUDA_TRY(stream_.create(), "starting");
  KD_CUDA_TRY(hit_seen_.create(), "starting");
  if (auto uploaded = upload_scene(); !uploaded) return uploaded;
  load_kernels();
  holding_.upload_seconds = timer.seconds();
  holding_.object_bytes = object_bytes(scene_, holding_.layout);
  holding_.scene_bytes = device_scene_.bytes() - holding_.object_bytes;
  holding_.strip_bytes = buffers_.bytes();
  size_t free = 0, total = 0;
  KD_CUDA_TRY(cudaMemGetInfo(&free, &total), "asking for the device's memory");
  holding_.device_bytes = total;
  return {};
}

struct Launch {
  const char* stage;
  Event start, end;
};

Result<RenderStats> CudaRenderer::run_stages(const FrameView& view, const Progress& progress) {
  const PipelinePlan plan = pipeline_plan(scene_, settings_, buffers_.targets());
  unsigned long long* const device_totals = buffers_.totals();
  std::deque<Launch> launches;  // whose elements stay where they are
  cudaError_t status = cudaMemsetAsync(device_totals, 0, kCounters * sizeof(*device_totals), stream_);
  hit_seen_.lower();
  bool cancelled = false;
  const auto launch = [&](const auto& stage, uint32_t* raised = nullptr) {
    if (cancelled) return;
    using Stage = std::decay_t<decltype(stage)>;
    Launch& record = launches.emplace_back(Stage::kName);
    record.start.record(stream_);
    const cudaError_t launched = launch_stage(stage, {device_totals + kCounter<Stage>, raised}, stream_);
    if (status == cudaSuccess) status = launched;
    record.end.record(stream_);
  };
  // The host goes on as soon as it is told of a hit, so that the next stage is there when this one ends; but never by
  // more than a sample, so that progress means something and an interruption is heard. A flag tells of most hits, the
  // count of all.
  const Launch* last_seen = nullptr;
  bool seen = false;
  const auto launch_and_see = [&](const auto& stage) {
    const auto note = [&](cudaError_t result) {
      if (status == cudaSuccess) status = result;
    };
    if (last_seen) note(last_seen->end.wait());
    launch(stage, hit_seen_.on_device());
    last_seen = &launches.back();
    while (!seen && last_seen->end.query() == cudaErrorNotReady) seen = hit_seen_.is_raised();
    if (!seen) {
      unsigned long long count = 0;
      note(download(&count, device_totals + kCounter<std::decay_t<decltype(stage)>>, 1, stream_));
      note(cudaStreamSynchronize(stream_));
      seen = count > 0;
    }
    const double share = static_cast<double>(launches.size()) / static_cast<double>(plan.launches());
    cancelled = cancelled || !keep_going(progress, min_of(share, 1.0));
    return seen;
  };
  run_pipeline(view, plan, launch, launch_and_see);
  unsigned long long totals[kCounters] = {};
  if (status == cudaSuccess) status = download(totals, device_totals, kCounters, stream_);
  if (status == cudaSuccess) status = cudaStreamSynchronize(stream_);
  KD_CUDA_TRY(status, "rendering");
  if (cancelled) return Error{ErrorClass::interrupted, "", "interrupted"};

  RenderStats stats;
  for (const Launch& launch : launches) stats.add_stage(launch.stage, launch.end.seconds_since(launch.start));
  stats.render_seconds = launches.back().end.seconds_since(launches.front().start);
  stats.primary_rays = size_t{view.width} * view.height * plan.primary_rays();
  stats.primary_hits = totals[kHits];
  stats.shadow_rays = totals[kShadowRays];
  return stats;
}

Result<void> CudaRenderer::download_strip(const FrameView& view, Strip strip, Frame& frame) {
  const char* action = "copying the film back";
  const size_t pixels = size_t{view.width} * view.height, first = size_t{view.width} * strip.first_row;
  float* const colour = frame.film.colour.data() + 4 * first;
  KD_CUDA_TRY(download(colour, &view.colour->colour.x, 4 * pixels, stream_), action);
  if (view.preview) KD_CUDA_TRY(download(frame.preview.data() + 3 * first, view.preview, 3 * pixels, stream_), action);
  for (size_t i = 0; i < frame.film.aovs.size(); ++i) {
    image::AovBuffer& buffer = frame.film.aovs[i];
    const auto components = static_cast<size_t>(image::aov_row(buffer.aov).components);
    const uint32_t* const words = buffers_.targets()[i].words;
    KD_CUDA_TRY(download(buffer.words.data() + components * first, words, components * pixels, stream_), action);
  }
  KD_CUDA_TRY(cudaStreamSynchronize(stream_), action);
  return {};
}

Result<RenderStats> CudaRenderer::render(Strip strip, Frame& frame, const Progress& progress) {
  KD_CUDA_TRY(cudaSetDevice(index_), "choosing the device");
  FrameView view = strip_view(scene_, settings_, strip);
  view.scene.layout = holding_.layout;
  device_scene_.set(view.scene);
  buffers_.set(view);
  auto stats = run_stages(view, progress);
  if (!stats) return stats;
  Timer timer;
  if (auto downloaded = download_strip(view, strip, frame); !downloaded) return downloaded.error();
  stats->download_seconds = timer.seconds();
  return stats;
}

}  // namespace

Result<std::unique_ptr<Renderer>> cuda_open(const LoadedScene& scene, const RenderSettings& settings, int index) {
  auto renderer = std::make_unique<CudaRenderer>(scene, settings, index);
  if (auto opened = renderer->open(); !opened) return opened.error();
  return std::unique_ptr<Renderer>(std::move(renderer));
}

}  // namespace kd::render
