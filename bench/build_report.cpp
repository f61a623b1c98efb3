#include "build_report.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "common/console.h"
#include "embree_build.h"
#include "machine.h"
#include "measure_rays.h"
#include "table.h"

namespace kd::bench {

namespace {

using tools::Json;

std::string mesh_name(const BuildMeasurement& m) { return std::filesystem::path(m.mesh).stem().string(); }

double per_triangle(const BuildMeasurement& m, uint64_t count) {
  return static_cast<double>(count) / static_cast<double>(m.triangles);
}

uint64_t node_count(const BuildMeasurement& m) { return uint64_t{m.tree.inner_nodes} + m.tree.leaves; }

Table tree_table(std::span<const BuildMeasurement> measurements) {
  Table table({"mesh", "triangles", "SAH cost", "refs/tri", "nodes/tri", "depth", "largest leaf", "empty leaves"});
  for (const BuildMeasurement& m : measurements) {
    table.add({mesh_name(m), fmt::format("{}", m.triangles), fmt::format("{:.2f}", m.tree.sah_cost),
               fmt::format("{:.2f}", per_triangle(m, m.references)),
               fmt::format("{:.2f}", per_triangle(m, node_count(m))), fmt::format("{}", m.tree.depth),
               fmt::format("{}", m.tree.largest_leaf),
               fmt::format("{:.1f} %", 100.0 * m.tree.empty_leaves / m.tree.leaves)});
  }
  return table;
}

Table build_table(std::span<const BuildMeasurement> measurements, const BuildEffort& effort) {
  Table table({"mesh", "1 thread, s", fmt::format("{} threads, s", effort.threads), "Embree medium, s",
               "Embree high, s", "ours / medium", "ours / high", "peak B/tri"});
  for (const BuildMeasurement& m : measurements) {
    const double ours = median(m.one_thread);
    const auto seconds = [](const std::vector<double>& s) {
      return s.empty() ? "-" : fmt::format("{:.3f}", median(s));
    };
    const auto ratio = [&](const std::vector<double>& s) {
      return s.empty() ? "-" : fmt::format("{:.1f}", ours / median(s));
    };
    table.add({mesh_name(m), seconds(m.one_thread), seconds(m.more_threads), seconds(m.embree_medium),
               seconds(m.embree_high), ratio(m.embree_medium), ratio(m.embree_high),
               fmt::format("{:.0f}", per_triangle(m, m.memory.added()))});
  }
  return table;
}

Table object_table(std::span<const BuildMeasurement> measurements) {
  Table table({"mesh", ".nkd B/tri", "nodes", "references", "triangles", "vertices", "rest", "open, ms", "expand, ms",
               "ready, ns/tri"});
  for (const BuildMeasurement& m : measurements) {
    std::vector<std::string> row{mesh_name(m)};
    for (uint64_t bytes :
         {m.bytes.total, m.bytes.nodes, m.bytes.references, m.bytes.triangles, m.bytes.vertices, m.bytes.rest()}) {
      row.push_back(fmt::format("{:.1f}", per_triangle(m, bytes)));
    }
    const double open = median(m.open), expand = median(m.expand);
    row.push_back(fmt::format("{:.2f}", 1e3 * open));
    row.push_back(fmt::format("{:.2f}", 1e3 * expand));
    row.push_back(fmt::format("{:.1f}", 1e9 * (open + expand) / static_cast<double>(m.triangles)));
    table.add(std::move(row));
  }
  return table;
}

Json seconds_json(const std::vector<double>& seconds) {
  return {{"median", median(seconds)},
          {"min", *std::min_element(seconds.begin(), seconds.end())},
          {"max", *std::max_element(seconds.begin(), seconds.end())}};
}

Json mesh_json(const BuildMeasurement& m) {
  Json seconds{{"build_one_thread", seconds_json(m.one_thread)},
               {"build", seconds_json(m.more_threads)},
               {"open", seconds_json(m.open)},
               {"expand", seconds_json(m.expand)}};
  if (!m.embree_medium.empty()) {
    seconds["embree_medium"] = seconds_json(m.embree_medium);
    seconds["embree_high"] = seconds_json(m.embree_high);
  }
  return {{"mesh", m.mesh},
          {"triangles", m.triangles},
          {"tree",
           {{"sah_cost", m.tree.sah_cost},
            {"nodes", node_count(m)},
            {"leaves", m.tree.leaves},
            {"empty_leaves", m.tree.empty_leaves},
            {"references", m.references},
            {"depth", m.tree.depth},
            {"largest_leaf", m.tree.largest_leaf}}},
          {"seconds", seconds},
          {"memory", {{"before", m.memory.before}, {"peak", m.memory.peak}}},
          {"bytes",
           {{"total", m.bytes.total},
            {"nodes", m.bytes.nodes},
            {"references", m.bytes.references},
            {"triangles", m.bytes.triangles},
            {"vertices", m.bytes.vertices},
            {"rest", m.bytes.rest()}}}};
}

}  // namespace

void print_circumstances(const tools::CompileSettings& settings, const BuildEffort& effort) {
  const Machine machine = this_machine();
  const auto embree = embree_version();
  const build::BuildSettings& s = settings.tree;
  fmt::print("{} on {}, {} cores; {}; {}\n", tools::version_text(), machine.processor, machine.cores, machine.compiler,
             embree ? *embree : fmt::format("no Embree column: {}", embree.error().what));
  fmt::print("costs {} : {}, empty bonus {}, byte price {}, depth {}, {} bits; medians of {}; Embree on one thread\n",
             s.costs.traversal, s.costs.intersection, s.costs.empty_bonus, s.costs.byte_price, s.max_depth,
             settings.bits, effort.repeats);
}

void print_builds(std::span<const BuildMeasurement> measurements, const BuildEffort& effort) {
  fmt::print("\nTree; SAH cost at 1 : 1.5\n\n{}", tree_table(measurements).markdown());
  fmt::print("\nBuilding it; peak: memory that compiling adds, from reading the mesh to the object on disk\n\n{}",
             build_table(measurements, effort).markdown());
  fmt::print(
      "\nThe object, bytes a triangle; ready to trace on the CPU = open (map, validate) + expand, one thread\n\n{}",
      object_table(measurements).markdown());
}

Json builds_json(std::span<const BuildMeasurement> measurements, const tools::CompileSettings& settings,
                 const BuildEffort& effort) {
  const Machine machine = this_machine();
  const auto embree = embree_version();
  const build::BuildSettings& s = settings.tree;
  Json j{{"version", 1},
         {"tool", tools::version_text()},
         {"machine", {{"processor", machine.processor}, {"cores", machine.cores}, {"compiler", machine.compiler}}},
         {"embree", embree ? *embree : embree.error().what},
         {"settings",
          {{"traversal_cost", s.costs.traversal},
           {"intersection_cost", s.costs.intersection},
           {"empty_bonus", s.costs.empty_bonus},
           {"byte_price", s.costs.byte_price},
           {"max_depth", s.max_depth},
           {"bits", settings.bits}}},
         {"threads", effort.threads},
         {"repeats", effort.repeats},
         {"meshes", Json::array()}};
  for (const BuildMeasurement& m : measurements) j["meshes"].push_back(mesh_json(m));
  return j;
}

}  // namespace kd::bench
