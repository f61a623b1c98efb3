#include "kdbuild/compile.h"

#include <bit>

#include <fmt/format.h>

#include "mesh/normalise.h"
#include "nkd/write.h"
#include "sys/timer.h"

namespace kd::tools {

namespace {

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

std::vector<uint8_t> stored_vertices(const mesh::LatticeMesh& lattice_mesh, VertexForm form) {
  const int bits = stored_vertex_bits(form, lattice_mesh.lattice.bits);
  if (form == VertexForm::lattice) return pack_triples(lattice_mesh.vertices, bits);
  std::vector<Vec3u> words;
  words.reserve(lattice_mesh.float_vertices.size());
  for (const Vec3f& v : lattice_mesh.float_vertices) {
    words.push_back({std::bit_cast<uint32_t>(v.x), std::bit_cast<uint32_t>(v.y), std::bit_cast<uint32_t>(v.z)});
  }
  return pack_triples(words, bits);
}

void report_lattice(const mesh::LatticeMesh& lattice_mesh, CompileReport& report) {
  report.lattice = lattice_mesh.lattice;
  report.triangles = lattice_mesh.triangles.size();
  report.vertices = lattice_mesh.vertices.size();
  report.welded_vertices = lattice_mesh.welded_vertices;
  report.collapsed = {lattice_mesh.collapsed_triangles, lattice_mesh.first_collapsed};
  report.max_displacement = lattice_mesh.max_displacement;
  report.rms_displacement = lattice_mesh.rms_displacement;
}

}  // namespace

Result<void> clean_mesh(mesh::Mesh& mesh, const std::string& where, CompileReport& report) {
  Timer timer;
  report.source_triangles = mesh.triangles.size();
  report.warnings = mesh.warnings;
  report.clean = mesh::clean(mesh);
  report.topology = mesh::topology(mesh);
  report.seconds.clean = timer.lap();
  if (!mesh.triangles.empty()) return {};
  return Error{ErrorClass::mesh, where,
               fmt::format("nothing is left of its {} triangles: {} have a coordinate that is not finite, {} no area",
                           report.source_triangles, report.clean.non_finite.count, report.clean.degenerate.count)};
}

Result<AtomicFile> compile(const mesh::Mesh& mesh, const ObjectTarget& target, const build::BuildSettings& settings,
                           CompileReport& report, const Progress& progress) {
  Timer timer;
  const mesh::LatticeMesh lattice_mesh = mesh::normalise(mesh, target.lattice, target.vertices);
  report_lattice(lattice_mesh, report);
  report.vertex_form = target.vertices;
  report.seconds.normalise += timer.lap();
  if (lattice_mesh.triangles.empty()) {
    return Error{ErrorClass::mesh, target.where,
                 fmt::format("every triangle collapses on a lattice of {} bits: use more", target.lattice.bits)};
  }

  auto tree =
      build::build_tree(lattice_mesh.lattice, lattice_mesh.vertices, lattice_mesh.triangles, settings, progress);
  if (!tree) return Error{tree.error().error_class, target.where, tree.error().what};
  report.tree = tree_statistics(tree->nodes, lattice_mesh.lattice);
  report.references = tree->references.size();
  report.seconds.build = timer.lap();

  const int bits = lattice_mesh.lattice.bits,
            corner_bits = nkd::Geometry::corner_bits_for(lattice_mesh.vertices.size());
  const std::vector<uint8_t> vertices = stored_vertices(lattice_mesh, target.vertices);
  const std::vector<uint8_t> triangles = pack_triples(lattice_mesh.triangles, corner_bits);
  const KeptAttributes attributes(mesh, lattice_mesh);
  const nkd::Summary summary{lattice_mesh.lattice, report.max_displacement, report.rms_displacement,
                             report.tree,          target.provenance,       mesh.material_names};
  auto file = AtomicFile::create(target.output);
  if (!file) return file.error();
  const auto written = nkd::write_object(file->temporary_path(), summary,
                                         {tree->nodes, tree->references, triangles, vertices, bits, target.vertices},
                                         attributes.view(mesh));
  if (!written) return Error{written.error().error_class, target.output, written.error().what};
  report.bytes = *written;
  report.seconds.write = timer.lap();
  return file;
}

}  // namespace kd::tools
