// The CPU backend: every stage as a parallel loop over the film's pixels, on all cores that ThreadLimit allows.
#pragma once

#include "render/backend.h"

namespace kd::render {

Result<std::string> cpu_probe(int index);
Result<Frame> cpu_render(const LoadedScene& scene, const RenderSettings& settings, int index);
Result<TraceOutcome> cpu_trace(const nkd::ObjectFile& object, const TraceJob& job, int index);

}  // namespace kd::render
