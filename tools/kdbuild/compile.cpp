#include "kdbuild/compile.h"

#include <filesystem>

#include <fmt/format.h>

#include "common/console.h"
#include "mesh/normalise.h"
#include "mesh/read_mesh.h"
#include "nkd/write.h"
#include "sys/hash.h"
#include "sys/mapped_file.h"
#include "sys/timer.h"

namespace kd::tools {

namespace {

std::vector<uint32_t> packed_vertices(const mesh::LatticeMesh& lattice_mesh) {
  const auto words = static_cast<size_t>(vertex_words(lattice_mesh.lattice.bits));
  std::vector<uint32_t> packed(lattice_mesh.vertices.size() * words);
  for (size_t i = 0; i < lattice_mesh.vertices.size(); ++i) {
    pack_vertex(lattice_mesh.vertices[i], lattice_mesh.lattice.bits, packed.data() + i * words);
  }
  return packed;
}

/// The mesh's attributes for the triangles that normalising kept. Owns what nkd::Attributes points to.
struct KeptAttributes {
  std::vector<uint32_t> source_primitives;
  std::vector<uint32_t> normal_indices;
  std::vector<uint16_t> material_ids;

  KeptAttributes(const mesh::Mesh& mesh, const mesh::LatticeMesh& lattice_mesh) {
    bool identity = true;
    for (uint32_t i = 0; i < lattice_mesh.kept.size(); ++i) {
      const uint32_t old = lattice_mesh.kept[i];
      source_primitives.push_back(mesh.source_primitives[old]);
      identity &= mesh.source_primitives[old] == i;
      if (!mesh.normal_indices.empty()) {
        normal_indices.insert(normal_indices.end(), mesh.normal_indices[old].begin(), mesh.normal_indices[old].end());
      }
      if (!mesh.material_ids.empty()) material_ids.push_back(mesh.material_ids[old]);
    }
    if (identity) source_primitives.clear();
  }

  nkd::Attributes view(const mesh::Mesh& mesh) const {
    return {source_primitives, mesh.normals, normal_indices, mesh.materials, material_ids};
  }
};

Result<uint64_t> hash_file(const std::string& path) {
  auto file = MappedFile::open(path);
  if (!file) return file.error();
  return hash_span(file->bytes());
}

std::span<const uint32_t> flat(std::span<const std::array<uint32_t, 3>> triangles) {
  return {reinterpret_cast<const uint32_t*>(triangles.data()), 3 * triangles.size()};
}

}  // namespace

std::string settings_text(const CompileSettings& s) {
  return fmt::format("--bits {}{}", s.bits, s.ambient_from_diffuse ? " --ambient-from-diffuse" : "");
}

Result<CompileReport> compile(const std::string& input, const std::string& output, const CompileSettings& settings,
                              const Progress& progress) {
  CompileReport report;
  Timer timer;
  auto mesh = mesh::read_mesh(input, {settings.ambient_from_diffuse});
  if (!mesh) return mesh.error();
  auto source_hash = hash_file(input);
  if (!source_hash) return source_hash.error();
  report.warnings = mesh->warnings;
  report.source_triangles = mesh->triangles.size();
  report.seconds.read = timer.lap();
  if (!keep_going(progress, 0)) return Error{ErrorClass::interrupted, input, "interrupted"};

  report.clean = mesh::clean(*mesh);
  report.topology = mesh::topology(*mesh);
  report.seconds.clean = timer.lap();
  if (mesh->triangles.empty()) {
    return Error{ErrorClass::mesh, input,
                 fmt::format("nothing is left of its {} triangles: {} have a coordinate that is not finite, {} no area",
                             report.source_triangles, report.clean.non_finite.count, report.clean.degenerate.count)};
  }

  const mesh::LatticeMesh lattice_mesh = mesh::normalise(*mesh, settings.bits);
  report.lattice = lattice_mesh.lattice;
  report.triangles = lattice_mesh.triangles.size();
  report.vertices = lattice_mesh.vertices.size();
  report.welded_vertices = lattice_mesh.welded_vertices;
  report.collapsed = {lattice_mesh.collapsed_triangles, lattice_mesh.first_collapsed};
  report.max_displacement = lattice_mesh.max_displacement;
  report.rms_displacement = lattice_mesh.rms_displacement;
  report.seconds.normalise = timer.lap();
  if (lattice_mesh.triangles.empty()) {
    return Error{ErrorClass::mesh, input,
                 fmt::format("every triangle collapses on a lattice of {} bits: use more", settings.bits)};
  }

  auto tree =
      build::build_tree(lattice_mesh.lattice, lattice_mesh.vertices, lattice_mesh.triangles, settings.tree, progress);
  if (!tree) return Error{tree.error().error_class, input, tree.error().what};
  report.tree = tree_statistics(tree->nodes, lattice_mesh.lattice);
  report.references = tree->references.size();
  report.seconds.build = timer.lap();

  const std::vector<uint32_t> vertices = packed_vertices(lattice_mesh);
  const KeptAttributes attributes(*mesh, lattice_mesh);
  const nkd::Summary summary{
      lattice_mesh.lattice,
      report.max_displacement,
      report.rms_displacement,
      report.tree,
      {std::filesystem::path(input).filename().string(), *source_hash, settings_text(settings), version_text()},
      mesh->material_names};
  const auto written = nkd::write_object(
      output, summary, {tree->nodes, tree->references, flat(lattice_mesh.triangles), vertices}, attributes.view(*mesh));
  if (!written) return written.error();
  report.bytes = *written;
  report.seconds.write = timer.lap();
  return report;
}

}  // namespace kd::tools
