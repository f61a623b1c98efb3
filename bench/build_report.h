// How the measurements of kdbench build are told: tables for reading, JSON for programs.
#pragma once

#include <span>

#include "common/report.h"
#include "measure_build.h"

namespace kd::bench {

/// What was measured with what, for the head of a report.
void print_circumstances(const tools::CompileSettings& settings, const BuildEffort& effort);

/// Three Markdown tables, a row a mesh: the tree, building it, the object.
void print_builds(std::span<const BuildMeasurement> measurements, const BuildEffort& effort);

/// schema/kdbench-build.schema.json.
tools::Json builds_json(std::span<const BuildMeasurement> measurements, const tools::CompileSettings& settings,
                        const BuildEffort& effort);

}  // namespace kd::bench
