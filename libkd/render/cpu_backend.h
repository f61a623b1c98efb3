// The CPU backend: every stage as a parallel loop over a strip's pixels, on all cores that ThreadLimit allows.
#pragma once

#include "render/backend.h"

namespace kd::render {

Result<int> cpu_count();
Result<std::string> cpu_probe(int index);
Result<std::unique_ptr<Renderer>> cpu_open(const LoadedScene& scene, const RenderSettings& settings, int index);
Result<TraceOutcome> cpu_trace(const nkd::ObjectFile& object, const TraceJob& job, int index);

}  // namespace kd::render
