// What every backend does alike with a frame and its strips.
#pragma once

#include "render/pipeline.h"
#include "render/renderer.h"

namespace kd::render {

/// All of a frame but the pointers to memory.
FrameView strip_view(const LoadedScene& scene, const RenderSettings& settings, Strip strip);

PipelinePlan pipeline_plan(const LoadedScene& scene, const RenderSettings& settings, std::span<const AovTarget> aovs);

/// Bytes that a pixel takes in a strip's buffers.
size_t bytes_a_pixel(const RenderSettings& settings);

/// Of all objects: traversal's bytes and those of the attribute sections that this render reads.
uint64_t object_bytes(const LoadedScene& scene, TriangleLayout layout);

/// A frame with buffers for all that is asked for.
Frame blank_frame(const LoadedScene& scene, const RenderSettings& settings);

}  // namespace kd::render
