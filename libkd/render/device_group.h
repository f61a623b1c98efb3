// The devices that share a scene's frames: each takes strips of a frame until there are none left, so that each gets
// what it is fast enough for. Which strips those are changes nothing in the picture.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/backend.h"

namespace kd::render {

class DeviceGroup {
 public:
  /// The scene on all `devices`, of which there is one at least. It outlives the group and keeps its place in memory.
  /// If `cpu_may_take_over`, the CPU stands in for devices that fail, now or later, for want of memory or altogether.
  static Result<DeviceGroup> open(std::vector<Device> devices, bool cpu_may_take_over, const LoadedScene& scene,
                                  const RenderSettings& settings);

  /// Takes over what `move_to` has moved in the scene.
  Result<void> follow(const Moved& moved);

  /// `progress` may cancel: ErrorClass::interrupted.
  Result<Frame> render(const Progress& progress);

  const std::vector<Device>& devices() const { return devices_; }
  /// Of all devices together.
  Holding holding() const;
  /// Strips that the last frame was rendered in.
  uint32_t strips() const { return strips_; }
  /// Why the CPU took over, or empty.
  const std::string& taken_over() const { return taken_over_; }

 private:
  Result<void> open_all();
  Result<Frame> render_once(const Progress& progress);
  bool take_over(const Error& error);

  std::vector<Device> devices_;
  std::vector<std::unique_ptr<Renderer>> renderers_;  // one a device
  bool cpu_may_take_over_ = false;
  std::string taken_over_;
  const LoadedScene* scene_ = nullptr;
  RenderSettings settings_;
  uint32_t strips_ = 0;
};

}  // namespace kd::render
