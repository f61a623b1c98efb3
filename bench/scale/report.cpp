#include "scale/report.h"

#include <fmt/format.h>

#include "common/console.h"
#include "machine.h"
#include "sys/parallel.h"
#include "table.h"

namespace kd::bench::scale {

namespace {

using tools::Json;

std::string ms(double seconds) { return fmt::format("{:.3f}", 1e3 * seconds); }
std::string mb(uint64_t bytes) { return fmt::format("{:.2f}", 1e-6 * static_cast<double>(bytes)); }

Json row_json(const SceneCost& row) {
  const SceneSeconds& s = row.seconds;
  return {{"count", row.count},
          {"instances", row.instances},
          {"objects_opened", row.objects_opened},
          {"seconds",
           {{"parse", s.parse},
            {"load", s.load},
            {"place", s.place},
            {"hierarchy", s.hierarchy},
            {"upload", s.upload},
            {"frame", s.frame}}},
          {"bytes", {{"file", row.file_bytes}, {"objects", row.object_bytes}, {"scene", row.scene_bytes}}},
          {"rays", {{"primary_hits", row.primary_hits}, {"shadow", row.shadow_rays}}}};
}

Json motion_json(const MotionCost& row) {
  return {{"count", row.count},
          {"instances", row.instances},
          {"moves", row.moves},
          {"rebuilds", row.rebuilds},
          {"seconds", {{"place", row.place_seconds}, {"move", row.move_seconds}}}};
}

}  // namespace

std::string markdown(const Series& series) {
  Table table({series.counts, "instances", "objects opened", "parse, ms", "load, ms", "of it placing", "hierarchy",
               "upload, ms", "frame, ms", "objects, MB", "instances, MB", "shadow rays"});
  for (const SceneCost& row : series.rows) {
    table.add({fmt::format("{}", row.count), fmt::format("{}", row.instances), fmt::format("{}", row.objects_opened),
               ms(row.seconds.parse), ms(row.seconds.load), ms(row.seconds.place), ms(row.seconds.hierarchy),
               ms(row.seconds.upload), ms(row.seconds.frame), mb(row.object_bytes), mb(row.scene_bytes),
               fmt::format("{}", row.shadow_rays)});
  }
  return fmt::format("{}\n\n{}", series.title, table.markdown());
}

std::string markdown(const std::vector<MotionCost>& motion) {
  Table table({"moving", "instances", "place all, ms", "move, ms", "moves that built again"});
  for (const MotionCost& row : motion) {
    table.add({fmt::format("{}", row.count), fmt::format("{}", row.instances), ms(row.place_seconds),
               ms(row.move_seconds), fmt::format("{} of {}", row.rebuilds, row.moves)});
  }
  return fmt::format("Instances that move from frame to frame, among others that do not\n\n{}", table.markdown());
}

Json scale_json(const ScaleRun& run) {
  const Machine machine = this_machine();
  Json j{{"version", 1},
         {"tool", tools::version_text()},
         {"machine", {{"processor", machine.processor}, {"cores", machine.cores}, {"compiler", machine.compiler}}},
         {"device", run.device},
         {"threads", thread_count()},
         {"film", {{"width", run.film.width}, {"height", run.film.height}}},
         {"repeats", run.effort.repeats},
         {"series", Json::array()},
         {"motion", Json::array()}};
  for (const Series& series : run.series) {
    Json rows = Json::array();
    for (const SceneCost& row : series.rows) rows.push_back(row_json(row));
    j["series"].push_back({{"name", series.name}, {"title", series.title}, {"counts", series.counts}, {"rows", rows}});
  }
  for (const MotionCost& row : run.motion) j["motion"].push_back(motion_json(row));
  return j;
}

}  // namespace kd::bench::scale
