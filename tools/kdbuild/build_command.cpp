// kdbuild build: one mesh in, one object out, and an account of what was done to it.
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "common/console.h"
#include "common/report.h"
#include "kdbuild/commands.h"
#include "kdbuild/compile.h"
#include "kdbuild/explain_report.h"
#include "mesh/read_mesh.h"
#include "sys/parallel.h"

namespace kd::tools {

namespace {

struct Options {
  std::string input, output, stats, plot;
  CompileSettings settings;
  unsigned threads = 0;
  bool quiet = false;
  bool explain = false;
};

Json fault_json(const mesh::FaceFault& fault) {
  Json j{{"count", fault.count}};
  if (fault.count > 0) j["first"] = fault.first;
  return j;
}

Json report_json(const Options& options, const CompileReport& r) {
  const auto vec = [](Vec3d v) { return Json::array({v.x, v.y, v.z}); };
  const auto& t = r.topology;
  return {
      {"version", 1},
      {"tool", version_text()},
      {"input", options.input},
      {"output", options.output},
      {"settings", settings_text(options.settings)},
      {"seconds",
       {{"read", r.seconds.read},
        {"clean", r.seconds.clean},
        {"normalise", r.seconds.normalise},
        {"build", r.seconds.build},
        {"write", r.seconds.write}}},
      {"mesh",
       {{"source_triangles", r.source_triangles},
        {"triangles", r.triangles},
        {"vertices", r.vertices},
        {"non_finite", fault_json(r.clean.non_finite)},
        {"degenerate", fault_json(r.clean.degenerate)},
        {"duplicate", fault_json(r.clean.duplicate)},
        {"opposite", fault_json(r.clean.opposite)},
        {"collapsed", fault_json(r.collapsed)},
        {"welded_vertices", r.welded_vertices},
        {"boundary_edges", t.boundary_edges},
        {"non_manifold_edges", t.non_manifold_edges},
        {"inconsistent_edges", t.inconsistent_edges},
        {"components", t.components},
        {"closed", t.closed}}},
      {"lattice", {{"bits", r.lattice.bits}, {"origin", vec(r.lattice.origin)}, {"extent", vec(r.lattice.extent)}}},
      {"error", {{"max", r.max_displacement}, {"rms", r.rms_displacement}}},
      {"tree",
       {{"sah_cost", r.tree.sah_cost},
        {"nodes", r.tree.inner_nodes + r.tree.leaves},
        {"leaves", r.tree.leaves},
        {"empty_leaves", r.tree.empty_leaves},
        {"references", r.references},
        {"depth", r.tree.depth},
        {"largest_leaf", r.tree.largest_leaf}}},
      {"bytes",
       {{"total", r.bytes}, {"per_triangle", static_cast<double>(r.bytes) / static_cast<double>(r.triangles)}}},
      {"warnings", r.warnings},
  };
}

void print_fault(const char* what, const char* fate, const mesh::FaceFault& fault) {
  if (fault.count > 0) fmt::print("  {} {}: {}, the first is triangle {}\n", fault.count, what, fate, fault.first);
}

void print_report(const Options& options, const CompileReport& r) {
  fmt::print("{} -> {}\n", options.input, options.output);
  fmt::print("  {} triangles, {} vertices in {}; {} boundary and {} non-manifold edges, {}\n", r.triangles, r.vertices,
             r.topology.components == 1 ? "one piece" : fmt::format("{} pieces", r.topology.components),
             r.topology.boundary_edges, r.topology.non_manifold_edges, r.topology.closed ? "closed" : "not closed");
  print_fault("with a coordinate that is not finite", "dropped", r.clean.non_finite);
  print_fault("without area", "dropped", r.clean.degenerate);
  print_fault("the same as an earlier one", "dropped", r.clean.duplicate);
  print_fault("the back of an earlier one", "kept", r.clean.opposite);
  print_fault("collapsed on the lattice", "dropped", r.collapsed);
  fmt::print("  lattice: {} bits, largest displacement {:.3g}, RMS {:.3g} (model units)\n", r.lattice.bits,
             r.max_displacement, r.rms_displacement);
  fmt::print("  tree: SAH cost {:.2f}, {} nodes, {:.2f} references a triangle, depth {}\n", r.tree.sah_cost,
             r.tree.inner_nodes + r.tree.leaves, static_cast<double>(r.references) / static_cast<double>(r.triangles),
             r.tree.depth);
  fmt::print("  {} bytes, {:.1f} a triangle; read {:.2f} s, clean {:.2f} s, build {:.2f} s, write {:.2f} s\n", r.bytes,
             static_cast<double>(r.bytes) / static_cast<double>(r.triangles), r.seconds.read,
             r.seconds.clean + r.seconds.normalise, r.seconds.build, r.seconds.write);
}

int run(const Options& options) {
  const ThreadLimit limit(options.threads);
  catch_interrupts();
  if (options.explain && options.stats == "-")
    return fail(kKdbuild, {ErrorClass::usage, "--explain", "stdout has the report of --stats -: give that a file"});
  if (auto usable = check_outputs({options.output, options.stats, options.plot}, {options.input}); !usable) {
    return fail(kKdbuild, usable.error());
  }
  const std::string name = std::filesystem::path(options.input).filename().string();
  const Progress progress = progress_bar(fmt::format("building {}", name), options.quiet);
  auto report = compile(options.input, options.output, options.settings, progress);
  keep_going(progress, 1);
  if (!report) return fail(kKdbuild, report.error());
  for (const std::string& warning : report->warnings) {
    warn(kKdbuild, options.input + ": " + warning);
  }
  if (!options.quiet && options.stats != "-") print_report(options, *report);
  if (!options.stats.empty()) {
    if (auto written = write_report(options.stats, report_json(options, *report)); !written)
      return fail(kKdbuild, written.error());
  }
  if (options.explain || !options.plot.empty()) {
    if (auto explained = explain_file(options.output, options.explain, options.plot); !explained)
      return fail(kKdbuild, explained.error());
  }
  return 0;
}

}  // namespace

Command build_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* c = app.add_subcommand("build", "Compile a mesh to an object");
  c->add_option("input", options->input, "Mesh: " + mesh::supported_formats())->required();
  c->add_option("-o,--output", options->output, "The .nkd to write")->required()->check(file_name());
  c->add_option("--bits", options->settings.bits, "Bits of the lattice an axis")
      ->check(whole_number(kMinLatticeBits, kMaxLatticeBits))
      ->capture_default_str();
  c->add_flag("--ambient-from-diffuse", options->settings.ambient_from_diffuse,
              "Take a material's ambient colour from its diffuse one, whatever the MTL's Ka says");
  c->add_option("--stats", options->stats, "Write a JSON report to this file, or to stdout (-)");
  c->add_flag("--explain", options->explain, "Tell why the tree costs what it costs: by depth, leaf and triangle");
  c->add_option("--plot", options->plot, "Draw that to this file, as SVG")->check(file_name());
  c->add_option("--threads", options->threads, "Threads to use; 0: all cores")
      ->check(whole_number(0, 4096))
      ->capture_default_str();
  c->add_flag("--quiet", options->quiet, "Print nothing but errors and warnings");
  return {c, [options] { return run(*options); }};
}

}  // namespace kd::tools
