#include "measure_build.h"

#include "common/console.h"
#include "embree_build.h"
#include "mesh/clean.h"
#include "mesh/normalise.h"
#include "mesh/read_mesh.h"
#include "nkd/object_file.h"
#include "render/expand.h"
#include "sys/parallel.h"
#include "sys/timer.h"

namespace kd::bench {

namespace {

/// Called after the mesh was compiled once: cleaning leaves something.
Result<mesh::LatticeMesh> read_lattice_mesh(const std::string& path, const tools::CompileSettings& settings) {
  auto mesh = mesh::read_mesh(path, {settings.ambient_from_diffuse});
  if (!mesh) return mesh.error();
  mesh::clean(*mesh);
  return mesh::normalise(*mesh, settings.bits);
}

Result<double> our_seconds(const mesh::LatticeMesh& m, const build::BuildSettings& settings, unsigned threads) {
  const ThreadLimit limit(threads);
  Timer timer;
  auto tree = build::build_tree(m.lattice, m.vertices, m.triangles, settings, tools::progress_bar("", true));
  const double seconds = timer.seconds();
  if (!tree) return tree.error();
  return seconds;
}

/// Appends what a timing gives, or says why it gives nothing.
Result<void> append(std::vector<double>& seconds, Result<double> timing) {
  if (!timing) return timing.error();
  seconds.push_back(*timing);
  return {};
}

Result<void> time_builds(const mesh::LatticeMesh& m, const build::BuildSettings& settings, const BuildEffort& effort,
                         BuildMeasurement& out) {
  std::vector<Vec3f> vertices;
  for (Vec3u v : m.vertices) vertices.push_back(vec_cast<float>(m.lattice.to_model(v)));
  const bool with_embree = static_cast<bool>(embree_version());
  const auto embree = [&](EmbreeQuality quality) { return embree_build_seconds(vertices, m.triangles, quality); };
  for (int i = 0; i < effort.repeats; ++i) {
    if (auto r = append(out.one_thread, our_seconds(m, settings, 1)); !r) return r;
    if (auto r = append(out.more_threads, our_seconds(m, settings, effort.threads)); !r) return r;
    if (!with_embree) continue;
    if (auto r = append(out.embree_medium, embree(EmbreeQuality::medium)); !r) return r;
    if (auto r = append(out.embree_high, embree(EmbreeQuality::high)); !r) return r;
  }
  return {};
}

/// A load takes milliseconds, so there are more of them than of builds.
constexpr int kLoadsPerBuild = 5;

/// Opens the object again and again; the first time is not counted, nor are the pages it brings in.
Result<void> time_loads(const std::string& object_path, int repeats, BuildMeasurement& out) {
  const ThreadLimit limit(1);
  for (int i = -1; i < kLoadsPerBuild * repeats; ++i) {
    Timer timer;
    auto object = nkd::ObjectFile::open(object_path);
    const double open = timer.lap();
    if (!object) return object.error();
    const auto expanded = render::expand_triangles(object->geometry());
    const double expand = timer.lap();
    if (i < 0) continue;
    out.open.push_back(open);
    out.expand.push_back(expand);
  }
  return {};
}

}  // namespace

Result<BuildMeasurement> measure_build(const std::string& mesh_path, const std::string& object_path,
                                       const PeakMemory& memory, const tools::CompileSettings& settings,
                                       const BuildEffort& effort) {
  BuildMeasurement out;
  out.mesh = mesh_path;
  out.memory = memory;
  auto lattice_mesh = read_lattice_mesh(mesh_path, settings);
  if (!lattice_mesh) return lattice_mesh.error();
  if (auto timed = time_builds(*lattice_mesh, settings.tree, effort, out); !timed) return timed.error();
  if (auto timed = time_loads(object_path, effort.repeats, out); !timed) return timed.error();

  auto object = nkd::ObjectFile::open(object_path);
  if (!object) return object.error();
  const nkd::Geometry& g = object->geometry();
  out.triangles = g.triangle_count();
  out.tree = object->summary().tree;
  out.references = g.references.size();
  out.bytes = {object->size(), g.nodes.size_bytes(), g.references.size_bytes(), g.triangles.size_bytes(),
               g.vertices.size_bytes()};
  return out;
}

}  // namespace kd::bench
