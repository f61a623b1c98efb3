#include "kdbuild/build_report.h"

#include <fmt/format.h>

#include "common/console.h"

namespace kd::tools {

namespace {

double per_triangle(uint64_t amount, const CompileReport& r) {
  return static_cast<double>(amount) / static_cast<double>(r.triangles);
}

Json fault_json(const mesh::FaceFault& fault) {
  Json j{{"count", fault.count}};
  if (fault.count > 0) j["first"] = fault.first;
  return j;
}

Json mesh_json(const CompileReport& r) {
  Json j = Json::object();
  if (!r.mesh_name.empty()) j["name"] = r.mesh_name;
  if (!r.up_to_date) j["source_triangles"] = r.source_triangles;
  j["triangles"] = r.triangles;
  j["vertices"] = r.vertices;
  if (r.up_to_date) return j;
  j["non_finite"] = fault_json(r.clean.non_finite);
  j["degenerate"] = fault_json(r.clean.degenerate);
  j["duplicate"] = fault_json(r.clean.duplicate);
  j["opposite"] = fault_json(r.clean.opposite);
  j["collapsed"] = fault_json(r.collapsed);
  j["welded_vertices"] = r.welded_vertices;
  j["boundary_edges"] = r.topology.boundary_edges;
  j["non_manifold_edges"] = r.topology.non_manifold_edges;
  j["inconsistent_edges"] = r.topology.inconsistent_edges;
  j["components"] = r.topology.components;
  j["closed"] = r.topology.closed;
  return j;
}

Json object_json(const std::string& input, const CompileReport& r, const CompileSettings& settings) {
  const auto vec = [](Vec3d v) { return Json::array({v.x, v.y, v.z}); };
  Json error{{"max", r.max_displacement}, {"rms", r.rms_displacement}};
  if (r.max_error) error["allowed"] = *r.max_error;
  return {
      {"version", 1},
      {"tool", version_text()},
      {"input", input},
      {"output", r.output},
      {"settings", settings_text(settings)},
      {"up_to_date", r.up_to_date},
      {"seconds",
       {{"read", r.seconds.read},
        {"clean", r.seconds.clean},
        {"normalise", r.seconds.normalise},
        {"build", r.seconds.build},
        {"write", r.seconds.write}}},
      {"mesh", mesh_json(r)},
      {"lattice", {{"bits", r.lattice.bits}, {"origin", vec(r.lattice.origin)}, {"extent", vec(r.lattice.extent)}}},
      {"error", error},
      {"tree",
       {{"sah_cost", r.tree.sah_cost},
        {"nodes", r.tree.inner_nodes + r.tree.leaves},
        {"leaves", r.tree.leaves},
        {"empty_leaves", r.tree.empty_leaves},
        {"references", r.references},
        {"depth", r.tree.depth},
        {"largest_leaf", r.tree.largest_leaf}}},
      {"bytes", {{"total", r.bytes}, {"per_triangle", per_triangle(r.bytes, r)}}},
      {"warnings", r.warnings},
  };
}

Json batch_json(const std::vector<Item>& items, const CompileSettings& settings, double seconds) {
  Json objects = Json::array(), scenes = objects, failed = objects, up_to_date = objects, warnings = objects;
  uint64_t triangles = 0, bytes = 0;
  for (const Item& item : items) {
    if (item.up_to_date()) up_to_date.push_back(item.job.input);
    if (item.error && item.report.failed.empty()) {
      failed.push_back({{"input", item.job.input},
                        {"error", item.error->line()},
                        {"status", static_cast<int>(item.error->error_class)}});
      continue;
    }
    for (const Error& error : item.report.failed) {
      failed.push_back(
          {{"input", item.job.input}, {"error", error.line()}, {"status", static_cast<int>(error.error_class)}});
    }
    if (!item.report.scene.empty()) scenes.push_back({{"input", item.job.input}, {"output", item.report.scene}});
    for (const std::string& warning : item.report.warnings) warnings.push_back(item.job.input + ": " + warning);
    for (const CompileReport& object : item.report.objects) {
      objects.push_back(object_json(item.job.input, object, settings));
      triangles += object.triangles;
      bytes += object.bytes;
    }
  }
  const size_t object_count = objects.size();
  return {{"version", 1},
          {"tool", version_text()},
          {"settings", settings_text(settings)},
          {"objects", std::move(objects)},
          {"scenes", std::move(scenes)},
          {"failed", std::move(failed)},
          {"up_to_date", std::move(up_to_date)},
          {"warnings", std::move(warnings)},
          {"totals",
           {{"inputs", items.size()},
            {"objects", object_count},
            {"triangles", triangles},
            {"bytes", bytes},
            {"seconds", seconds}}}};
}

void print_fault(const char* what, const char* fate, const mesh::FaceFault& fault) {
  if (fault.count > 0) fmt::print("  {} {}: {}, the first is triangle {}\n", fault.count, what, fate, fault.first);
}

void print_object(const std::string& input, const CompileReport& r) {
  fmt::print("{}{} -> {}\n", input, r.mesh_name.empty() ? "" : fmt::format(" ({})", r.mesh_name), r.output);
  fmt::print("  {} triangles, {} vertices in {}; {} boundary and {} non-manifold edges, {}\n", r.triangles, r.vertices,
             r.topology.components == 1 ? "one piece" : fmt::format("{} pieces", r.topology.components),
             r.topology.boundary_edges, r.topology.non_manifold_edges, r.topology.closed ? "closed" : "not closed");
  print_fault("with a coordinate that is not finite", "dropped", r.clean.non_finite);
  print_fault("without area", "dropped", r.clean.degenerate);
  print_fault("the same as an earlier one", "dropped", r.clean.duplicate);
  print_fault("the back of an earlier one", "kept", r.clean.opposite);
  print_fault("collapsed on the lattice", "dropped", r.collapsed);
  fmt::print("  lattice: {} bits{}{}, largest displacement {:.3g}, RMS {:.3g} (model units)\n", r.lattice.bits,
             r.max_error ? fmt::format(" (the fewest for {:.3g})", *r.max_error) : "",
             r.vertex_form == VertexForm::float32 ? ", vertices in float32" : "", r.max_displacement,
             r.rms_displacement);
  fmt::print("  tree: SAH cost {:.2f}, {} nodes, {:.2f} references a triangle, depth {}\n", r.tree.sah_cost,
             r.tree.inner_nodes + r.tree.leaves, per_triangle(r.references, r), r.tree.depth);
  fmt::print("  {} bytes, {:.1f} a triangle; read {:.2f} s, clean {:.2f} s, build {:.2f} s, write {:.2f} s\n", r.bytes,
             per_triangle(r.bytes, r), r.seconds.read, r.seconds.clean + r.seconds.normalise, r.seconds.build,
             r.seconds.write);
}

}  // namespace

void print_report(const Item& item) {
  if (item.up_to_date()) {
    fmt::print("{} -> {}: up to date\n", item.job.input, item.output());
    return;
  }
  for (const std::string& note : item.report.notes) fmt::print("{}\n", note);
  for (const CompileReport& object : item.report.objects) print_object(item.job.input, object);
  if (!item.report.scene.empty()) {
    fmt::print("{} -> {}: a scene of {} objects in {} parts\n", item.job.input, item.report.scene,
               item.report.objects.size(), item.report.parts);
  }
}

Json report_json(const std::vector<Item>& items, const CompileSettings& settings, double seconds) {
  const Item& first = items.front();
  const bool one = items.size() == 1 && !first.error && first.report.scene.empty();
  return one ? object_json(first.job.input, first.report.objects.front(), settings)
             : batch_json(items, settings, seconds);
}

}  // namespace kd::tools
