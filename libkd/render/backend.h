// Backends: what runs the pipeline. To add one: its file, and a row in backend.cpp.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "render/load.h"
#include "render/renderer.h"
#include "render/trace.h"
#include "sys/result.h"

namespace kd::render {

struct Backend {
  std::string_view name;
  /// How many devices there are, or why there is none.
  Result<int> (*count)();
  /// What the device is called, or why there is none of this index.
  Result<std::string> (*probe)(int index);
  /// The scene on the device. It outlives the renderer and keeps its place in memory. Where its objects' geometry is
  /// still being checked, what comes of that; ErrorClass::object.
  Result<std::unique_ptr<Renderer>> (*open)(const LoadedScene& scene, const RenderSettings& settings, int index);
  Result<TraceOutcome> (*trace)(const nkd::ObjectFile& object, const TraceJob& job, int index);
};

/// A device that a user asked for, found.
struct Device {
  const Backend* backend = nullptr;
  int index = 0;
  std::string description;  // "CUDA 0: NVIDIA H100 80GB HBM3", "CPU: 2 threads"
  std::string reason;       // why this one, if the choice was ours; else empty
};

/// "auto", "cpu", "cuda", "cuda:N", "cuda:all", or several of these with commas between them; none twice.
/// ErrorClass::usage for anything else, ErrorClass::device for a device that is not there. "auto", which stands alone,
/// takes the first CUDA device, or else the CPU.
Result<std::vector<Device>> choose_devices(std::string_view wanted);

/// The same for what runs on one device: ErrorClass::usage for a list.
Result<Device> choose_device(std::string_view wanted);

/// The CPU, whatever else there is.
Device cpu_device();

/// Whether this build has the CUDA backend.
bool built_with_cuda();

}  // namespace kd::render
