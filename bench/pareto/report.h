// How kdbench pareto tells what it measured: a table for reading, CSV for plots, JSON for programs.
#pragma once

#include <span>
#include <string>

#include "common/report.h"
#include "pareto/measure.h"
#include "table.h"

namespace kd::bench {

/// Where and how all of it was measured.
struct Circumstances {
  std::string device;
  std::string processor;
  unsigned threads = 0;
  std::string compiler;
  ImageSize size;
  ParetoEffort effort;
};

/// Markdown: a row a form, and below the table the two ratios that requirements name.
std::string markdown(const MeshResult& mesh);

/// A row a mesh and form; units in the heads.
Table csv_table(const Circumstances& circumstances, std::span<const MeshResult> meshes);

/// schema/kdbench-pareto.schema.json.
tools::Json pareto_json(const Circumstances& circumstances, std::span<const MeshResult> meshes);

}  // namespace kd::bench
