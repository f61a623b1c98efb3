#include "render/cuda/cuda_backend.h"

#include <algorithm>
#include <memory>

#include "render/cuda/device_memory.h"
#include "render/pipeline.h"
#include "render/stage_times.h"
#include "sys/timer.h"

namespace kd::render {

namespace {

constexpr unsigned kBlock = 128;

unsigned blocks_for(size_t count) { return static_cast<unsigned>((count + kBlock - 1) / kBlock); }

/// Returns an Error from the enclosing function if a CUDA call fails.
#define KD_CUDA_TRY(call, action)                                     \
  do {                                                                \
    if (const cudaError_t status_ = (call); status_ != cudaSuccess) { \
      cudaGetLastError();                                             \
      return cuda_error(status_, action);                             \
    }                                                                 \
  } while (false)

__global__ void expand_kernel(PackedTriangles packed, uint32_t count, TriangleVertices* triangles) {
  const uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < count) packed.expand(i, triangles[i]);
}

/// Pixel of a thread: a warp covers a tile of 8 x 4 pixels, so that its rays stay together.
__device__ uint32_t tiled_pixel(uint32_t thread, uint32_t width, uint32_t height) {
  const uint32_t tiles_across = (width + 7) / 8;
  const uint32_t tile = thread / 32, lane = thread % 32;
  const uint32_t x = tile % tiles_across * 8 + lane % 8, y = tile / tiles_across * 4 + lane / 8;
  return x < width && y < height ? y * width + x : kNone;
}

/// Blocks a multiprocessor is to hold of a kernel that traces one object: on an H100 64 registers a thread and 8 blocks
/// are 2 % faster than 56 and 9 for primary and shadow rays and as fast for bounce rays; 48 and 10 are slower.
constexpr unsigned kTraceBlocks = 8;

/// The same for a stage; those that trace through a hierarchy take what they need.
template <class Stage>
constexpr unsigned kStageBlocks = 1;
template <>
constexpr unsigned kStageBlocks<ObjectIntersection<OnlyInstance>> = kTraceBlocks;
template <>
constexpr unsigned kStageBlocks<Lighting<OnlyInstance>> = kTraceBlocks;

template <class Stage>
__global__ void __launch_bounds__(kBlock, kStageBlocks<Stage>) stage_kernel(Stage stage, unsigned long long* total) {
  const uint32_t pixel = tiled_pixel(blockIdx.x * blockDim.x + threadIdx.x, stage.frame.width, stage.frame.height);
  const bool counted = pixel != kNone && stage(pixel) != 0;
  if constexpr (kCounter<Stage> != kCounters) {
    const unsigned lanes = __ballot_sync(~0u, counted);
    if (threadIdx.x % 32 == 0 && lanes != 0) atomicAdd(total, static_cast<unsigned long long>(__popc(lanes)));
  }
}

template <RayMode mode, class Test>
__global__ void __launch_bounds__(kBlock, kTraceBlocks)
    trace_kernel(TraceView view, const RayRecord* rays, uint32_t count, HitRecord* hits) {
  const uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= count) return;
  NoCounter counter;
  hits[i] = trace_ray<mode, Test>(view, load(rays + i), counter);
}

class Stream {
 public:
  Stream() = default;
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  ~Stream() {
    if (stream_) cudaStreamDestroy(stream_);
  }
  cudaError_t create() { return cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking); }
  operator cudaStream_t() const { return stream_; }

 private:
  cudaStream_t stream_ = nullptr;
};

class Event {
 public:
  Event() { cudaEventCreate(&event_); }
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;
  ~Event() { cudaEventDestroy(event_); }
  void record(cudaStream_t stream) { cudaEventRecord(event_, stream); }
  double seconds_since(const Event& start) const {
    float milliseconds = 0;
    cudaEventElapsedTime(&milliseconds, start.event_, event_);
    return 1e-3 * milliseconds;
  }

 private:
  cudaEvent_t event_ = nullptr;
};

/// Copies a section to its piece; does nothing on the pass that only lays pieces out.
template <class T>
cudaError_t upload(T* piece, std::span<const T> section, cudaStream_t stream) {
  if (!piece) return cudaSuccess;
  return cudaMemcpyAsync(piece, section.data(), section.size_bytes(), cudaMemcpyHostToDevice, stream);
}

/// One object's pieces: what stays, and the packed vertices and corners that only the expansion reads.
struct DeviceObject {
  Node* nodes;
  uint32_t* references;
  TriangleVertices* triangles;
};

DeviceObject object_pieces(DeviceMemory& memory, const nkd::Geometry& geometry) {
  DeviceObject object;
  object.nodes = memory.piece<Node>(geometry.nodes.size());
  object.references = memory.piece<uint32_t>(geometry.references.size());
  object.triangles = memory.piece<TriangleVertices>(geometry.triangle_count());
  return object;
}

uint64_t traversal_bytes(const nkd::Geometry& g) {
  return g.nodes.size_bytes() + g.references.size_bytes() + g.triangle_count() * sizeof(TriangleVertices);
}

/// Where packed sections wait for their expansion; shared by all objects, sized for the largest.
struct Staging {
  uint8_t* vertices;
  uint8_t* corners;
};

Staging staging_pieces(DeviceMemory& memory, size_t most_vertices, size_t most_corners) {
  return {memory.piece<uint8_t>(most_vertices), memory.piece<uint8_t>(most_corners)};
}

cudaError_t fill_object(const DeviceObject& object, const Staging& staging, const nkd::Geometry& geometry,
                        cudaStream_t stream) {
  cudaError_t status = upload(object.nodes, geometry.nodes, stream);
  if (status == cudaSuccess) status = upload(object.references, geometry.references, stream);
  if (status == cudaSuccess) status = upload(staging.vertices, geometry.vertices, stream);
  if (status == cudaSuccess) status = upload(staging.corners, geometry.triangles, stream);
  if (status != cudaSuccess) return status;
  const auto count = static_cast<uint32_t>(geometry.triangle_count());
  const PackedTriangles packed{
      {staging.corners, geometry.corner_bits()}, {staging.vertices, geometry.vertex_bits()}, geometry.form};
  expand_kernel<<<blocks_for(count), kBlock, 0, stream>>>(packed, count, object.triangles);
  return cudaGetLastError();
}

/// The scene's and the frame's pieces. `lay_out` runs twice: once to add up sizes, once to hand out addresses.
class DeviceScene {
 public:
  DeviceScene(const LoadedScene& scene, const RenderSettings& settings) : scene_(scene), settings_(settings) {}

  Result<void> create(cudaStream_t stream);
  FrameView frame() const { return frame_; }
  std::span<const AovTarget> targets() const { return targets_; }
  unsigned long long* totals() const { return totals_; }
  cudaError_t clear_totals(cudaStream_t stream) const {
    return cudaMemsetAsync(totals_, 0, kCounters * sizeof(*totals_), stream);
  }
  uint64_t object_bytes() const { return object_bytes_; }
  uint64_t frame_bytes() const { return frame_bytes_; }

 private:
  void lay_out();
  Result<void> fill(cudaStream_t stream);

  const LoadedScene& scene_;
  const RenderSettings& settings_;
  DeviceMemory memory_;
  FrameView frame_;
  Staging staging_{};
  std::vector<DeviceObject> objects_;
  std::vector<ShadedObjectView> object_views_;
  std::vector<AovTarget> targets_;
  InstanceView* instances_ = nullptr;
  ShadedObjectView* objects_on_device_ = nullptr;
  HierarchyNode* hierarchy_ = nullptr;
  Material* overrides_ = nullptr;
  LightView* lights_ = nullptr;
  unsigned long long* totals_ = nullptr;
  uint64_t object_bytes_ = 0;
  uint64_t frame_bytes_ = 0;
};

void DeviceScene::lay_out() {
  const size_t pixels = size_t{scene_.film.width} * scene_.film.height;
  size_t most_vertices = 0, most_corners = 0;
  objects_.assign(scene_.objects.size(), {});
  object_views_.assign(scene_.objects.size(), {});
  object_bytes_ = 0;
  for (size_t i = 0; i < scene_.objects.size(); ++i) {
    if (!scene_.objects[i].file) continue;
    const nkd::ObjectFile& file = *scene_.objects[i].file;
    const nkd::Attributes& a = scene_.objects[i].attributes;
    most_vertices = std::max(most_vertices, file.geometry().vertices.size());
    most_corners = std::max(most_corners, file.geometry().triangles.size());
    objects_[i] = object_pieces(memory_, file.geometry());
    object_views_[i] = {{objects_[i].nodes, objects_[i].references, objects_[i].triangles, file.summary().lattice.bits},
                        file.summary().lattice.step(),
                        memory_.piece<uint32_t>(a.source_primitives.size()),
                        memory_.piece<Vec3f>(a.normals.size()),
                        memory_.piece<uint32_t>(a.normal_indices.size()),
                        memory_.piece<Material>(a.materials.size()),
                        memory_.piece<uint16_t>(a.material_ids.size())};
    object_bytes_ += traversal_bytes(file.geometry()) + a.source_primitives.size_bytes() + a.normals.size_bytes() +
                     a.normal_indices.size_bytes() + a.materials.size_bytes() + a.material_ids.size_bytes();
  }
  staging_ = staging_pieces(memory_, most_vertices, most_corners);
  instances_ = memory_.piece<InstanceView>(scene_.instances.size());
  objects_on_device_ = memory_.piece<ShadedObjectView>(scene_.objects.size());
  hierarchy_ = memory_.piece<HierarchyNode>(scene_.hierarchy.size());
  overrides_ = memory_.piece<Material>(scene_.overrides.size());
  lights_ = memory_.piece<LightView>(scene_.lights.size());
  totals_ = memory_.piece<unsigned long long>(kCounters);

  frame_.scene = {hierarchy_,     instances_,       objects_on_device_,
                  overrides_,     lights_,          static_cast<uint32_t>(scene_.instances.size()),
                  scene_.ambient, scene_.background};
  frame_.camera = scene_.camera;
  frame_.width = scene_.film.width;
  frame_.height = scene_.film.height;
  frame_.inverse_gamma = 1 / settings_.gamma;
  frame_.hits = memory_.piece<SurfaceHit>(pixels);
  frame_.colour = memory_.piece<Pixel>(pixels);
  frame_.preview = memory_.piece<uint8_t>(settings_.preview ? 3 * pixels : 0);
  frame_bytes_ = pixels * (sizeof(SurfaceHit) + sizeof(Pixel) + (settings_.preview ? 3 : 0));
  targets_.clear();
  for (image::Aov aov : settings_.aovs) {
    const size_t words = static_cast<size_t>(image::aov_row(aov).components) * pixels;
    targets_.push_back({aov, memory_.piece<uint32_t>(words)});
    frame_bytes_ += words * sizeof(uint32_t);
  }
}

Result<void> DeviceScene::create(cudaStream_t stream) {
  lay_out();
  if (auto allocated = memory_.allocate(); !allocated) return allocated.error();
  lay_out();
  return fill(stream);
}

Result<void> DeviceScene::fill(cudaStream_t stream) {
  const char* action = "uploading the scene";
  for (size_t i = 0; i < scene_.objects.size(); ++i) {
    if (!scene_.objects[i].file) continue;
    const nkd::ObjectFile& file = *scene_.objects[i].file;
    const nkd::Attributes& a = scene_.objects[i].attributes;
    const ShadedObjectView& v = object_views_[i];
    KD_CUDA_TRY(fill_object(objects_[i], staging_, file.geometry(), stream), action);
    KD_CUDA_TRY(upload(const_cast<uint32_t*>(v.source_primitives), a.source_primitives, stream), action);
    KD_CUDA_TRY(upload(const_cast<Vec3f*>(v.normals), a.normals, stream), action);
    KD_CUDA_TRY(upload(const_cast<uint32_t*>(v.normal_indices), a.normal_indices, stream), action);
    KD_CUDA_TRY(upload(const_cast<Material*>(v.materials), a.materials, stream), action);
    KD_CUDA_TRY(upload(const_cast<uint16_t*>(v.material_ids), a.material_ids, stream), action);
  }
  const std::vector<InstanceView> instances = instance_views(scene_);
  KD_CUDA_TRY(upload(instances_, std::span<const InstanceView>(instances), stream), action);
  KD_CUDA_TRY(upload(objects_on_device_, std::span<const ShadedObjectView>(object_views_), stream), action);
  KD_CUDA_TRY(upload(hierarchy_, std::span<const HierarchyNode>(scene_.hierarchy), stream), action);
  KD_CUDA_TRY(upload(overrides_, std::span<const Material>(scene_.overrides), stream), action);
  KD_CUDA_TRY(upload(lights_, std::span<const LightView>(scene_.lights), stream), action);
  KD_CUDA_TRY(cudaStreamSynchronize(stream), action);
  return {};
}

struct Launch {
  const char* stage;
  Event start, end;
};

template <class T>
cudaError_t download(std::vector<T>& to, const T* from, size_t count, cudaStream_t stream) {
  to.resize(count);
  return count == 0 ? cudaSuccess : cudaMemcpyAsync(to.data(), from, count * sizeof(T), cudaMemcpyDeviceToHost, stream);
}

}  // namespace

Result<std::string> cuda_probe(int index) {
  int count = 0;
  if (const cudaError_t status = cudaGetDeviceCount(&count); status != cudaSuccess) {
    cudaGetLastError();
    int driver = 0;  // stays 0 where there is none, which CUDA tells as one that is too old
    cudaDriverGetVersion(&driver);
    const char* why = driver == 0 ? "there is no NVIDIA driver on this machine" : cudaGetErrorString(status);
    return Error{ErrorClass::device, "", std::string("no CUDA device: ") + why};
  }
  if (index >= count) {
    return Error{ErrorClass::device, "",
                 "no CUDA device " + std::to_string(index) + ": there are " + std::to_string(count)};
  }
  cudaDeviceProp properties;
  KD_CUDA_TRY(cudaGetDeviceProperties(&properties, index), "reading the device's properties");
  return "CUDA " + std::to_string(index) + ": " + properties.name;
}

Result<Frame> cuda_render(const LoadedScene& scene, const RenderSettings& settings, int index) {
  Frame out;
  Timer timer;
  KD_CUDA_TRY(cudaSetDevice(index), "choosing the device");
  Stream stream;
  KD_CUDA_TRY(stream.create(), "starting");
  DeviceScene device(scene, settings);
  if (auto created = device.create(stream); !created) return created.error();
  out.stats.upload_seconds = timer.lap();
  out.stats.object_bytes = device.object_bytes();
  out.stats.frame_bytes = device.frame_bytes();

  const FrameView frame = device.frame();
  const size_t tiles = size_t{(frame.width + 7) / 8} * ((frame.height + 3) / 4);
  std::vector<std::unique_ptr<Launch>> launches;
  const PipelinePlan plan{static_cast<uint32_t>(scene.lights.size()), device.targets(), settings.preview,
                          settings.gamma_on_film};
  cudaError_t launched = cudaSuccess;
  const auto launch = [&](const auto& stage) {
    using Stage = std::decay_t<decltype(stage)>;
    Launch& record = *launches.emplace_back(std::make_unique<Launch>());
    record.stage = Stage::kName;
    record.start.record(stream);
    stage_kernel<<<blocks_for(tiles * 32), kBlock, 0, stream>>>(stage, device.totals() + kCounter<Stage>);
    if (launched == cudaSuccess) launched = cudaGetLastError();
    record.end.record(stream);
  };
  const auto launch_and_count = [&](const auto& stage) -> uint64_t {
    launch(stage);
    unsigned long long count = 0;
    const unsigned long long* total = device.totals() + kCounter<std::decay_t<decltype(stage)>>;
    const cudaError_t copied = cudaMemcpyAsync(&count, total, sizeof(count), cudaMemcpyDeviceToHost, stream);
    const cudaError_t waited = copied == cudaSuccess ? cudaStreamSynchronize(stream) : copied;
    if (launched == cudaSuccess) launched = waited;
    return count;
  };
  for (int warm_ups = settings.warm_ups; warm_ups >= 0; --warm_ups) {
    launches.clear();
    KD_CUDA_TRY(device.clear_totals(stream), "starting");
    run_pipeline(frame, plan, launch, launch_and_count);
    KD_CUDA_TRY(launched, "launching a stage");
    KD_CUDA_TRY(cudaStreamSynchronize(stream), "rendering");
  }
  if (!keep_going(settings.progress, 1)) return Error{ErrorClass::interrupted, "", "interrupted"};
  for (const auto& launch : launches)
    add_stage_time(out.stats, launch->stage, launch->end.seconds_since(launch->start));
  out.stats.render_seconds = launches.back()->end.seconds_since(launches.front()->start);

  timer.lap();
  const size_t pixels = size_t{frame.width} * frame.height;
  const char* action = "copying the film back";
  out.film.width = frame.width;
  out.film.height = frame.height;
  KD_CUDA_TRY(download(out.film.colour, &frame.colour->colour.x, 4 * pixels, stream), action);
  KD_CUDA_TRY(download(out.preview, frame.preview, settings.preview ? 3 * pixels : 0, stream), action);
  for (const AovTarget& target : device.targets()) {
    image::AovBuffer& buffer = out.film.aovs.emplace_back();
    buffer.aov = target.aov;
    const size_t words = static_cast<size_t>(image::aov_row(target.aov).components) * pixels;
    KD_CUDA_TRY(download(buffer.words, target.words, words, stream), action);
  }
  std::vector<unsigned long long> totals;
  KD_CUDA_TRY(download(totals, device.totals(), kCounters, stream), action);
  KD_CUDA_TRY(cudaStreamSynchronize(stream), action);
  out.stats.primary_rays = pixels;
  out.stats.primary_hits = totals[kHits];
  out.stats.shadow_rays = totals[kShadowRays];
  out.stats.download_seconds = timer.lap();
  return out;
}

Result<TraceOutcome> cuda_trace(const nkd::ObjectFile& object, const TraceJob& job, int index) {
  auto sources = object.source_primitives();
  if (!sources) return sources.error();
  const nkd::Geometry& geometry = object.geometry();
  const Lattice& lattice = object.summary().lattice;
  KD_CUDA_TRY(cudaSetDevice(index), "choosing the device");
  Stream stream;
  KD_CUDA_TRY(stream.create(), "starting");

  DeviceMemory memory;
  DeviceObject pieces{};
  Staging staging{};
  uint32_t* source_primitives = nullptr;
  RayRecord* rays = nullptr;
  HitRecord* hits = nullptr;
  const auto lay_out = [&] {
    pieces = object_pieces(memory, geometry);
    staging = staging_pieces(memory, geometry.vertices.size(), geometry.triangles.size());
    source_primitives = memory.piece<uint32_t>(sources->size());
    rays = memory.piece<RayRecord>(job.rays.size());
    hits = memory.piece<HitRecord>(job.rays.size());
  };
  lay_out();
  if (auto allocated = memory.allocate(); !allocated) return allocated.error();
  lay_out();
  KD_CUDA_TRY(fill_object(pieces, staging, geometry, stream), "uploading the object");
  KD_CUDA_TRY(upload(source_primitives, *sources, stream), "uploading the object");
  KD_CUDA_TRY(upload(rays, job.rays, stream), "uploading the rays");

  const TraceView view{
      {pieces.nodes, pieces.references, pieces.triangles, lattice.bits}, invert(lattice.frame()), source_primitives};
  const auto count = static_cast<uint32_t>(job.rays.size());
  const auto launch = [&] {
    if (count == 0) return;
    with_kernel(job, [&]<RayMode mode, class Test>() {
      trace_kernel<mode, Test><<<blocks_for(count), kBlock, 0, stream>>>(view, rays, count, hits);
    });
  };
  TraceOutcome out;
  Event start, end;
  for (int i = 0; i < job.warm_ups; ++i) launch();
  for (int i = 0; i < job.repeats; ++i) {
    start.record(stream);
    launch();
    end.record(stream);
    KD_CUDA_TRY(cudaStreamSynchronize(stream), "tracing");
    out.seconds.push_back(end.seconds_since(start));
  }
  KD_CUDA_TRY(cudaGetLastError(), "tracing");
  KD_CUDA_TRY(download(out.hits, hits, count, stream), "copying the hits back");
  KD_CUDA_TRY(cudaStreamSynchronize(stream), "copying the hits back");
  out.device_bytes = traversal_bytes(geometry);
  return out;
}

}  // namespace kd::render
