// The CUDA backend: every stage as a kernel over the film's pixels. Sections are uploaded as they lie in the mapped
// .nkd; triangles are expanded by a kernel. One allocation holds all there is.
#pragma once

#include "render/backend.h"

namespace kd::render {

Result<std::string> cuda_probe(int index);
Result<Frame> cuda_render(const LoadedScene& scene, const RenderSettings& settings, int index);
Result<TraceOutcome> cuda_trace(const nkd::ObjectFile& object, const TraceJob& job, int index);

}  // namespace kd::render
