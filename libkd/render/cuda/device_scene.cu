#include "render/cuda/device_scene.h"

namespace kd::render {

namespace {

/// A section to its piece, whose pointer the views hold as one to constants.
template <class T>
cudaError_t fill_piece(const T* piece, std::span<const T> section, cudaStream_t stream) {
  return upload(const_cast<T*>(piece), section, stream);
}

__global__ void scatter_kernel(const InstanceView* moved, const uint32_t* indices, uint32_t count,
                               InstanceView* instances) {
  const uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < count) instances[indices[i]] = moved[i];
}

}  // namespace

DeviceScene::~DeviceScene() {
  if (pinned_) cudaHostUnregister(const_cast<void*>(pinned_));
}

void DeviceScene::lay_out(const LoadedScene& scene, TriangleLayout layout) {
  memory_.section("objects");
  objects_.assign(scene.objects.size(), {});
  object_views_.assign(scene.objects.size(), {});
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    const nkd::ObjectFile& file = scene.objects[i].file;
    const nkd::Attributes& a = scene.objects[i].attributes;
    objects_[i] = object_pieces(memory_, file.geometry(), layout);
    object_views_[i] = {
        objects_[i].view(file.summary().lattice.bits),       file.summary().lattice.step(),
        memory_.piece<uint32_t>(a.source_primitives.size()), memory_.piece<Vec3f>(a.normals.size()),
        memory_.piece<uint32_t>(a.normal_indices.size()),    memory_.piece<Material>(a.materials.size()),
        memory_.piece<uint16_t>(a.material_ids.size())};
  }
  view_.objects = memory_.piece<ShadedObjectView>(scene.objects.size());
  view_.object_numbers = memory_.piece<uint32_t>(scene.object_numbers.size());
  memory_.section("instances");
  view_.instances = memory_.piece<InstanceView>(scene.instances.size());
  view_.front_only = memory_.piece<uint8_t>(scene.front_only.size());
  view_.instance_numbers = memory_.piece<uint32_t>(scene.instance_numbers.size());
  view_.overrides = memory_.piece<Material>(scene.overrides.size());
  memory_.section("hierarchy");
  view_.hierarchy = memory_.piece<HierarchyNode>(scene.hierarchy.size());
  memory_.section("lights");
  view_.lights = memory_.piece<LightView>(scene.most_lights);
}

Result<void> DeviceScene::create(const LoadedScene& scene, TriangleLayout layout, cudaStream_t stream) {
  memory_.release();
  lay_out(scene, layout);
  if (auto allocated = memory_.allocate(); !allocated) return allocated;
  lay_out(scene, layout);
  return fill(scene, stream);
}

Result<void> DeviceScene::fill(const LoadedScene& scene, cudaStream_t stream) {
  Staging staging;
  for (const LoadedObject& object : scene.objects) staging.include(object.file.geometry());
  if (auto allocated = staging.allocate(); !allocated) return allocated;
  const char* action = "uploading the scene";
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    const nkd::Attributes& a = scene.objects[i].attributes;
    const ShadedObjectView& v = object_views_[i];
    if (auto sound = scene.checks.sound(i); !sound) return sound;  // meanwhile the next ones are looked at
    KD_CUDA_TRY(fill_object(objects_[i], staging, scene.objects[i].file.geometry(), stream), action);
    KD_CUDA_TRY(fill_piece(v.source_primitives, a.source_primitives, stream), action);
    KD_CUDA_TRY(fill_piece(v.normals, a.normals, stream), action);
    KD_CUDA_TRY(fill_piece(v.normal_indices, a.normal_indices, stream), action);
    KD_CUDA_TRY(fill_piece(v.materials, a.materials, stream), action);
    KD_CUDA_TRY(fill_piece(v.material_ids, a.material_ids, stream), action);
  }
  const std::vector<InstanceView> instances = instance_views(scene);
  KD_CUDA_TRY(fill_piece(view_.objects, std::span<const ShadedObjectView>(object_views_), stream), action);
  KD_CUDA_TRY(fill_piece(view_.instances, std::span<const InstanceView>(instances), stream), action);
  KD_CUDA_TRY(fill_piece(view_.object_numbers, std::span<const uint32_t>(scene.object_numbers), stream), action);
  KD_CUDA_TRY(fill_piece(view_.front_only, scene.front_only, stream), action);
  KD_CUDA_TRY(fill_piece(view_.instance_numbers, scene.instance_numbers, stream), action);
  KD_CUDA_TRY(fill_piece(view_.overrides, std::span<const Material>(scene.overrides), stream), action);
  KD_CUDA_TRY(fill_piece(view_.hierarchy, scene.hierarchy, stream), action);
  KD_CUDA_TRY(fill_piece(view_.lights, std::span<const LightView>(scene.lights), stream), action);
  KD_CUDA_TRY(cudaStreamSynchronize(stream), action);
  if (scene.moves && !scene.hierarchy.empty()) {
    void* const nodes = const_cast<HierarchyNode*>(scene.hierarchy.data());
    // Where the system does not allow it, copies are slower.
    if (cudaHostRegister(nodes, scene.hierarchy.size_bytes(), cudaHostRegisterDefault) == cudaSuccess) pinned_ = nodes;
    cudaGetLastError();
  }
  return {};
}

Result<void> DeviceScene::follow(const LoadedScene& scene, const Moved& moved, cudaStream_t stream) {
  const char* action = "moving the scene";
  KD_CUDA_TRY(fill_piece(view_.lights, std::span<const LightView>(scene.lights), stream), action);
  if (moved.instances.empty()) return {};
  // All nodes: which of them are above what has moved is not known, and the copy costs less than to find out.
  KD_CUDA_TRY(fill_piece(view_.hierarchy, scene.hierarchy, stream), action);
  std::vector<InstanceView> views;
  views.reserve(moved.instances.size());
  for (uint32_t i : moved.instances) views.push_back(instance_view(scene, scene.instances[i]));
  DeviceMemory arrived;
  InstanceView* arrived_views = nullptr;
  uint32_t* indices = nullptr;
  const auto lay_out_arrivals = [&] {
    arrived.section("moved instances");
    arrived_views = arrived.piece<InstanceView>(views.size());
    indices = arrived.piece<uint32_t>(views.size());
  };
  lay_out_arrivals();
  if (auto allocated = arrived.allocate(); !allocated) return allocated;
  lay_out_arrivals();
  KD_CUDA_TRY(upload(arrived_views, std::span<const InstanceView>(views), stream), action);
  KD_CUDA_TRY(upload(indices, moved.instances, stream), action);
  const auto count = static_cast<uint32_t>(views.size());
  scatter_kernel<<<blocks_for(count), kBlock, 0, stream>>>(arrived_views, indices, count,
                                                           const_cast<InstanceView*>(view_.instances));
  KD_CUDA_TRY(cudaGetLastError(), action);
  KD_CUDA_TRY(cudaStreamSynchronize(stream), action);
  return {};
}

}  // namespace kd::render
