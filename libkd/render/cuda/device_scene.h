// A scene on a device: objects, instances, their hierarchy, lights. One allocation.
#pragma once

#include "render/cuda/device_object.h"
#include "render/load.h"
#include "render/view.h"

namespace kd::render {

class DeviceScene {
 public:
  DeviceScene() = default;
  DeviceScene(const DeviceScene&) = delete;
  DeviceScene& operator=(const DeviceScene&) = delete;
  ~DeviceScene();

  /// Uploads, and waits until all is there. What was there before is given back first.
  Result<void> create(const LoadedScene& scene, TriangleLayout layout, cudaStream_t stream);
  /// The same of what has moved, and the lights as they are.
  Result<void> follow(const LoadedScene& scene, const Moved& moved, cudaStream_t stream);
  /// Sets what points to memory, and nothing else.
  void set(SceneView& view) const {
    view.hierarchy = view_.hierarchy;
    view.instances = view_.instances;
    view.objects = view_.objects;
    view.overrides = view_.overrides;
    view.lights = view_.lights;
    view.front_only = view_.front_only;
    view.instance_numbers = view_.instance_numbers;
    view.object_numbers = view_.object_numbers;
  }
  size_t bytes() const { return memory_.bytes(); }

 private:
  void lay_out(const LoadedScene& scene, TriangleLayout layout);
  Result<void> fill(const LoadedScene& scene, cudaStream_t stream);

  DeviceMemory memory_;
  SceneView view_;                // its pointers alone
  const void* pinned_ = nullptr;  // the scene's hierarchy, if it moves: its copies are then as fast as the bus
  std::vector<DeviceObject> objects_;
  std::vector<ShadedObjectView> object_views_;
};

}  // namespace kd::render
