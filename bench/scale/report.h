// What the sweeps of kdbench scale found: tables for reading, JSON for programs.
#pragma once

#include <string>
#include <vector>

#include "common/report.h"
#include "scale/measure.h"

namespace kd::bench::scale {

struct Series {
  std::string name;    // as the report calls it
  std::string title;   // what is held and what grows
  std::string counts;  // head of the column of what grows
  std::vector<SceneCost> rows;
};

struct ScaleRun {
  std::string device;
  scene::FilmSize film;
  Effort effort;
  std::vector<Series> series;
  std::vector<MotionCost> motion;
};

std::string markdown(const Series& series);
std::string markdown(const std::vector<MotionCost>& motion);

/// schema/kdbench-scale.schema.json.
tools::Json scale_json(const ScaleRun& run);

}  // namespace kd::bench::scale
