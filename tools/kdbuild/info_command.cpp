// kdbuild info: what an object holds.
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "common/console.h"
#include "common/report.h"
#include "kdbuild/commands.h"
#include "kdbuild/explain_report.h"
#include "nkd/object_file.h"
#include "sys/hash.h"

namespace kd::tools {

namespace {

struct Options {
  std::string file;
  std::string format = "text";
  std::string plot;
  bool explain = false;
};

Json info_json(const nkd::ObjectFile& file) {
  const nkd::Summary& s = file.summary();
  const nkd::Geometry& g = file.geometry();
  const auto vec = [](Vec3d v) { return Json::array({v.x, v.y, v.z}); };
  return {
      {"version", 1},
      {"file", file.path()},
      {"bytes", file.size()},
      {"triangles", g.triangle_count()},
      {"vertices", g.vertex_count()},
      {"vertex_form", name_of(g.form)},
      {"lattice", {{"bits", s.lattice.bits}, {"origin", vec(s.lattice.origin)}, {"extent", vec(s.lattice.extent)}}},
      {"error", {{"max", s.max_displacement}, {"rms", s.rms_displacement}}},
      {"tree",
       {{"sah_cost", s.tree.sah_cost},
        {"nodes", s.tree.inner_nodes + s.tree.leaves},
        {"leaves", s.tree.leaves},
        {"empty_leaves", s.tree.empty_leaves},
        {"references", g.references.size()},
        {"depth", s.tree.depth},
        {"largest_leaf", s.tree.largest_leaf}}},
      {"sections",
       {{"nodes", g.nodes.size_bytes()},
        {"references", g.references.size_bytes()},
        {"triangles", g.triangles.size_bytes()},
        {"vertices", g.vertices.size_bytes()},
        {"source_primitives", file.has_source_primitives()},
        {"normals", file.has_normals()},
        {"materials", file.has_materials()}}},
      {"materials", s.material_names},
      {"source",
       {{"name", s.provenance.source_name},
        {"hash", hash_text(s.provenance.source_hash)},
        {"settings", s.provenance.settings},
        {"writer", s.provenance.writer}}},
  };
}

void print_info(const nkd::ObjectFile& file) {
  const nkd::Summary& s = file.summary();
  const nkd::Geometry& g = file.geometry();
  const size_t triangles = g.triangle_count();
  const Vec3d lo = s.lattice.origin, hi = lo + s.lattice.extent;
  const auto per_triangle = [&](uint64_t bytes) { return static_cast<double>(bytes) / static_cast<double>(triangles); };
  const auto line = [&](const char* name, uint64_t count, uint64_t bytes) {
    fmt::print("  {:<12} {:>10}  {:>11} bytes  {:5.1f} a triangle\n", name, count, bytes, per_triangle(bytes));
  };
  fmt::print("{}: {} triangles, {} bytes, {:.1f} a triangle\n", file.path(), triangles, file.size(),
             per_triangle(file.size()));
  fmt::print("  made from {} (XXH3 {}) by {} with {}\n", s.provenance.source_name, hash_text(s.provenance.source_hash),
             s.provenance.writer, s.provenance.settings);
  fmt::print("  box [{:.6g} {:.6g} {:.6g}]..[{:.6g} {:.6g} {:.6g}], {} bits an axis{}\n", lo.x, lo.y, lo.z, hi.x, hi.y,
             hi.z, s.lattice.bits, g.form == VertexForm::float32 ? "; vertices in float32" : "");
  fmt::print("  largest displacement {:.3g}, RMS {:.3g} (model units)\n", s.max_displacement, s.rms_displacement);
  fmt::print("  SAH cost {:.2f} (1 : 1.5); depth {}, {} of {} leaves empty, the largest has {} triangles\n",
             s.tree.sah_cost, s.tree.depth, s.tree.empty_leaves, s.tree.leaves, s.tree.largest_leaf);
  line("nodes", g.nodes.size(), g.nodes.size_bytes());
  line("references", g.references.size(), g.references.size_bytes());
  line("triangles", triangles, g.triangles.size_bytes());
  line("vertices", g.vertex_count(), g.vertices.size_bytes());
  fmt::print("  normals: {}; materials: {}\n", file.has_normals() ? "yes" : "none",
             s.material_names.empty() ? "none" : fmt::format("{}", fmt::join(s.material_names, ", ")));
}

int run(const Options& options) {
  if (auto usable = check_outputs({options.plot}, {options.file}); !usable) return fail(kKdbuild, usable.error());
  auto file = nkd::ObjectFile::open(options.file);
  if (!file) return fail(kKdbuild, file.error());
  std::optional<ObjectExplanation> explanation;
  if (options.explain || !options.plot.empty()) explanation = explain_object(*file);
  if (!options.plot.empty()) {
    if (auto written = write_explanation_svg(options.plot, *explanation); !written)
      return fail(kKdbuild, written.error());
  }
  if (options.format == "json") {
    Json info = info_json(*file);
    if (options.explain) info["explanation"] = explanation_json(*explanation);
    if (auto written = write_report("-", info); !written) return fail(kKdbuild, written.error());
  } else {
    print_info(*file);
    if (options.explain) print_explanation(*explanation);
  }
  return 0;
}

}  // namespace

Command info_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* c = app.add_subcommand("info", "Tell what an object holds");
  c->add_option("file", options->file, "A .nkd")->required();
  c->add_option("--format", options->format, "text or json")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str();
  c->add_flag("--explain", options->explain, "Tell why the tree costs what it costs: by depth, leaf and triangle");
  c->add_option("--plot", options->plot, "Draw that to this file, as SVG")->check(file_name());
  return {c, [options] { return run(*options); }};
}

}  // namespace kd::tools
