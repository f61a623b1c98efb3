#include <deque>

#include "paper/run.h"
#include "render/cuda/device_scene.h"
#include "render/cuda/stage_kernel.h"
#include "render/strip.h"

namespace kd::bench::paper {

namespace {

using render::Event;
using render::kBlock;

/// Blocks a multiprocessor is to hold of a stage's kernel: of those that trace one object in a thread as many as of the
/// product's.
template <class Stage>
constexpr unsigned kStageBlocks = 1;
template <>
constexpr unsigned kStageBlocks<DenseIntersection> = render::kTraceBlocks;
template <>
constexpr unsigned kStageBlocks<DenseShadow> = render::kTraceBlocks;
template <>
constexpr unsigned kStageBlocks<ReducedIntersection<OnlyInstance>> = render::kTraceBlocks;
template <bool up_to_first>
constexpr unsigned kStageBlocks<ReducedShadow<OnlyInstance, up_to_first>> = render::kTraceBlocks;

/// Whole blocks a plane; within one, a warp covers a tile of pixels as in the product.
template <class Stage>
__global__ void __launch_bounds__(kBlock, kStageBlocks<Stage>) plane_kernel(Stage stage, uint32_t blocks_a_plane) {
  const uint32_t plane = blockIdx.x / blocks_a_plane, block = blockIdx.x % blocks_a_plane;
  const uint32_t width = stage.strip.frame.width;
  const uint32_t pixel = render::tiled_pixel(block * blockDim.x + threadIdx.x, width, stage.strip.pixels / width);
  if (pixel != kNone) stage(pixel, plane);
}

struct Launch {
  const char* stage;
  Event start, end;
};

/// The frame's hits and film, a strip's buffers, and the launches of a form.
class CudaForm {
 public:
  CudaForm(const FrameView& frame, const Buffers& buffers, cudaStream_t stream) : buffers_(buffers), stream_(stream) {
    strip_.frame = frame;
  }

  Result<void> allocate() {
    lay_out();
    if (auto allocated = memory_.allocate(); !allocated) return allocated;
    lay_out();
    return {};
  }

  /// A frame; its stages' times and the whole's.
  Result<render::RenderStats> render(const Job& job, uint32_t rows, uint32_t lights, bool gamma) {
    std::deque<Launch> launches;  // whose elements stay where they are
    run_film(job.form, strip_, rows, lights, gamma, [&]<class Stage>(const Stage& stage, uint32_t planes) {
      const uint32_t width = stage.strip.frame.width, height = stage.strip.pixels / width;
      const unsigned blocks = render::blocks_for(size_t{(width + 7) / 8} * ((height + 3) / 4) * 32);
      Launch& record = launches.emplace_back(Stage::kName);
      record.start.record(stream_);
      plane_kernel<<<blocks * planes, kBlock, 0, stream_>>>(stage, blocks);
      record.end.record(stream_);
    });
    KD_CUDA_TRY(cudaGetLastError(), "launching a stage");
    KD_CUDA_TRY(cudaStreamSynchronize(stream_), "rendering");
    render::RenderStats stats;
    for (const Launch& launch : launches) stats.add_stage(launch.stage, launch.end.seconds_since(launch.start));
    stats.render_seconds = launches.back().end.seconds_since(launches.front().start);
    return stats;
  }

  Result<void> download_film(std::vector<float>& film) const {
    const size_t words = 4 * pixels();
    film.resize(words);
    KD_CUDA_TRY(render::download(film.data(), &strip_.frame.colour->colour.x, words, stream_), "copying the film back");
    KD_CUDA_TRY(cudaStreamSynchronize(stream_), "copying the film back");
    return {};
  }

 private:
  size_t pixels() const { return size_t{strip_.frame.width} * strip_.frame.height; }
  void lay_out() {
    memory_.section("hits and film");
    strip_.frame.hits = memory_.piece<SurfaceHit>(pixels());
    strip_.frame.colour = memory_.piece<render::Pixel>(pixels());
    memory_.section("buffers");
    strip_.rays = memory_.piece<Ray>(buffers_.rays);
    strip_.intersections = memory_.piece<SurfaceHit>(buffers_.intersections);
    strip_.shadow_rays = memory_.piece<Ray>(buffers_.shadow_rays);
    strip_.occluded = memory_.piece<uint8_t>(buffers_.shadow_tests);
  }

  StripView strip_;
  Buffers buffers_;
  cudaStream_t stream_;
  render::DeviceMemory memory_;
};

}  // namespace

Result<Run> run_on_cuda(const render::LoadedScene& scene, const render::RenderSettings& settings, const Job& job,
                        int device_index) {
  KD_CUDA_TRY(cudaSetDevice(device_index), "choosing the device");
  render::Stream stream;
  KD_CUDA_TRY(stream.create(), "starting");
  render::DeviceScene device_scene;
  if (auto created = device_scene.create(scene, TriangleLayout::expanded, stream); !created) return created.error();
  FrameView frame = render::strip_view(scene, settings, {0, scene.film.height});
  device_scene.set(frame.scene);

  Run out;
  const auto lights = static_cast<uint32_t>(scene.lights.size());
  auto division = divide(frame, lights, job, out);
  if (!division) return division.error();
  CudaForm form(frame, division->buffers, stream);
  if (auto allocated = form.allocate(); !allocated) return allocated.error();
  for (int i = -job.warm_ups; i < job.repeats; ++i) {
    if (!keep_going(job.progress, 0)) return Error{ErrorClass::interrupted, "", "interrupted"};
    auto stats = form.render(job, division->rows, lights, settings.gamma_on_film);
    if (!stats) return stats.error();
    if (i >= 0) out.frames.push_back(std::move(*stats));
  }
  if (auto copied = form.download_film(out.film); !copied) return copied.error();
  return out;
}

}  // namespace kd::bench::paper
