// The CUDA backend: every stage as a kernel over a strip's pixels. Sections are uploaded as they lie in the mapped
// .nkd; triangles are expanded by a kernel.
#pragma once

#include "render/backend.h"

namespace kd::render {

Result<int> cuda_count();
Result<std::string> cuda_probe(int index);
Result<std::unique_ptr<Renderer>> cuda_open(const LoadedScene& scene, const RenderSettings& settings, int index);
Result<TraceOutcome> cuda_trace(const nkd::ObjectFile& object, const TraceJob& job, int index);

}  // namespace kd::render
