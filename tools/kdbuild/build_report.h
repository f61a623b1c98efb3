// What kdbuild build tells: text for people, JSON (schema/kdbuild-stats.schema.json) for programs.
#pragma once

#include "common/report.h"
#include "kdbuild/batch.h"

namespace kd::tools {

/// What happened to a source, on stdout: a block of lines for each object that was built.
void print_report(const Item& item);

/// One object made of one source has a report of its own; anything else, a report of reports.
Json report_json(const std::vector<Item>& items, const CompileSettings& settings, double seconds);

}  // namespace kd::tools
