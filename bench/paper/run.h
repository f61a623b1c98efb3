// A form of the pipeline, run and timed on a device.
#pragma once

#include <vector>

#include "paper/forms.h"
#include "render/backend.h"

namespace kd::bench::paper {

struct Job {
  Form form = Form::dense;
  uint64_t most_bytes = 0;  // of a strip's buffers
  int warm_ups = 0;         // frames before those that are timed
  int repeats = 1;
  Progress progress = {};  // may cancel between frames
};

struct Run {
  std::vector<float> film;                  // as image::Film::colour
  std::vector<render::RenderStats> frames;  // stages and render_seconds
  uint32_t strips = 1;
  uint64_t frame_bytes = 0;      // buffers of a strip, hits and film
  uint64_t undivided_bytes = 0;  // what they would be in one strip
};

/// Of the settings, gamma on the film is heeded, AOVs and the preview are not. ErrorClass::resource if not one row's
/// buffers fit in `most_bytes`, or what was allowed is not there; ErrorClass::interrupted; on CUDA
/// ErrorClass::device too, as in a build without CUDA.
Result<Run> run_on_cpu(const render::LoadedScene& scene, const render::RenderSettings& settings, const Job& job);
Result<Run> run_on_cuda(const render::LoadedScene& scene, const render::RenderSettings& settings, const Job& job,
                        int device_index);

/// How a frame is divided. ErrorClass::resource.
struct Division {
  uint32_t rows = 0;  // of a strip
  Buffers buffers;    // of a strip
};
Result<Division> divide(const FrameView& frame, uint32_t lights, const Job& job, Run& run);

}  // namespace kd::bench::paper
