// Backends: what runs the pipeline. To add one: its file, and a row in backend.cpp.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "image/film.h"
#include "render/load.h"
#include "render/trace.h"
#include "sys/result.h"

namespace kd::render {

struct StageTime {
  std::string stage;
  double seconds = 0;
  uint32_t launches = 0;
};

struct RenderStats {
  double upload_seconds = 0;    // objects to the device, expanded
  double render_seconds = 0;    // stages, first launch to last
  double download_seconds = 0;  // the film's way back
  std::vector<StageTime> stages;
  uint64_t primary_rays = 0;
  uint64_t primary_hits = 0;
  uint64_t shadow_rays = 0;
  uint64_t object_bytes = 0;  // on the device: nodes, references, triangles, attributes
  uint64_t frame_bytes = 0;   // on the device: rays, hits, film, AOVs
};

struct Frame {
  image::Film film;
  std::vector<uint8_t> preview;  // RGB, 8 bits; empty unless asked for
  RenderStats stats;
};

struct Backend {
  std::string_view name;
  /// What the device is called, or why there is none.
  Result<std::string> (*probe)(int index);
  Result<Frame> (*render)(const LoadedScene& scene, const RenderSettings& settings, int index);
  Result<TraceOutcome> (*trace)(const nkd::ObjectFile& object, const TraceJob& job, int index);
};

/// A device that a user asked for, found.
struct Device {
  const Backend* backend = nullptr;
  int index = 0;
  std::string description;  // "CUDA 0: NVIDIA H100 80GB HBM3", "CPU: 2 threads"
  std::string reason;       // why this one, if the choice was ours; else empty
};

/// "auto", "cpu", "cuda" or "cuda:N". ErrorClass::usage for anything else, ErrorClass::device for a device that is not
/// there. "auto" takes the first CUDA device, or else the CPU.
Result<Device> choose_device(std::string_view wanted);

/// Whether this build has the CUDA backend.
bool built_with_cuda();

}  // namespace kd::render
