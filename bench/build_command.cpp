// kdbench build: what compiling meshes takes, and what comes of it, beside Embree's builds over the same triangles.
#include <memory>

#include <fmt/format.h>

#include "build_report.h"
#include "commands.h"
#include "common/console.h"
#include "scratch_folder.h"

namespace kd::bench {

namespace {

struct Options {
  std::vector<std::string> meshes;
  std::string json;
  tools::CompileSettings settings;
  BuildEffort effort;
};

Result<void> measure(const Options& o) {
  tools::catch_interrupts();
  if (auto usable = tools::check_outputs({o.json}, o.meshes); !usable) return usable;
  auto scratch = ScratchFolder::create();
  if (!scratch) return scratch.error();
  const auto object_path = [&](size_t i) { return scratch->file(fmt::format("{}.nkd", i)); };
  const bool text = o.json != "-";
  if (text) print_circumstances(o.settings, o.effort);

  // Memory first, of all meshes: a process that has started threads cannot fork.
  std::vector<PeakMemory> memory;
  for (size_t i = 0; i < o.meshes.size(); ++i) {
    auto peak = compile_in_child(o.meshes[i], object_path(i), o.settings, o.effort.threads);
    if (!peak) return peak.error();
    memory.push_back(*peak);
  }
  std::vector<BuildMeasurement> measurements;
  for (size_t i = 0; i < o.meshes.size(); ++i) {
    auto measured = measure_build(o.meshes[i], object_path(i), memory[i], o.settings, o.effort);
    if (!measured) return measured.error();
    measurements.push_back(std::move(*measured));
  }
  if (text) print_builds(measurements, o.effort);
  if (o.json.empty()) return {};
  return tools::write_report(o.json, builds_json(measurements, o.settings, o.effort));
}

}  // namespace

Command build_command(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* c = app.add_subcommand("build", "Measure building and loading: seconds, memory, bytes, the tree's cost");
  build::BuildSettings& tree = o->settings.tree;
  c->add_option("meshes", o->meshes, "Meshes, as kdbuild reads them")->required();
  c->add_option("--repeat", o->effort.repeats, "Timed runs")
      ->check(tools::whole_number(1, 100000))
      ->capture_default_str();
  c->add_option("--threads", o->effort.threads,
                "Threads of the builds that are not on one, and while memory is measured")
      ->check(tools::whole_number(1, 4096))
      ->capture_default_str();
  c->add_option("--traversal-cost", tree.costs.traversal, "What the builder takes a traversal step to cost")
      ->check(tools::number(1e-6, 1e6))
      ->capture_default_str();
  c->add_option("--intersection-cost", tree.costs.intersection, "What it takes a triangle test to cost")
      ->check(tools::number(1e-6, 1e6))
      ->capture_default_str();
  c->add_option("--empty-bonus", tree.costs.empty_bonus,
                "Share of a split's cost forgiven where it cuts off empty space")
      ->check(tools::number(0, 0.999))
      ->capture_default_str();
  c->add_option("--byte-price", tree.costs.byte_price, "SAH cost that a byte a triangle is worth")
      ->check(tools::number(0, 1e6))
      ->capture_default_str();
  c->add_option("--max-depth", tree.max_depth, "Longest path in inner nodes")
      ->check(tools::whole_number(1, kMaxDepth))
      ->capture_default_str();
  c->add_option("--json", o->json, "Write a JSON report to this file, or to stdout (-)");
  return {c, [o] {
            const auto done = measure(*o);
            return done ? 0 : tools::fail(kKdbench, done.error());
          }};
}

}  // namespace kd::bench
