#include "kdbuild/build_source.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "common/console.h"
#include "kdbuild/asset_scene.h"
#include "kdbuild/estimate.h"
#include "kdbuild/freshness.h"
#include "mesh/lattice_fit.h"
#include "mesh/split.h"
#include "scene/write_scene.h"
#include "sys/atomic_file.h"
#include "sys/timer.h"

namespace kd::tools {

namespace {

/// A mesh on its way to an object, or to several.
struct Lot {
  uint32_t mesh = 0;  // of the asset
  std::string where;
  CompileReport report;
  Box3d box;          // of the mesh, model space
  Lattice lattice;    // shared by the materials of what was one mesh
  size_t pieces = 0;  // made so far, if it had to be split
};

/// An object that is whole but does not bear its name yet.
struct Staged {
  AtomicFile file;
  SceneMember member;
};

class SourceBuild {
 public:
  SourceBuild(const Job& job, const CompileSettings& settings, Claims& claims, const Progress& progress)
      : job_(job), settings_(settings), claims_(claims), progress_(progress) {}

  Result<SourceReport> run(const Fingerprint& known);

 private:
  Result<void> read(const Fingerprint& known);
  Result<void> clean();
  Result<void> choose_lattices();
  Result<void> choose_lattice(std::span<Lot> lots);
  Result<int> choose_bits(std::span<const mesh::Mesh* const> meshes, const mesh::LatticeFit& fit) const;
  Result<void> compile_all();
  Result<bool> seems_to_fit(const Lot& lot, const mesh::Mesh& mesh);
  Result<void> compile_fitting(Lot& lot, mesh::Mesh mesh, CompileReport report, bool is_piece);
  Result<void> compile_halves(Lot& lot, mesh::Mesh mesh, CompileReport report);
  Result<void> compile_one(Lot& lot, const mesh::Mesh& mesh, CompileReport report, bool is_piece);
  Result<void> commit();

  Result<void> set_aside(const Error& error);
  mesh::Mesh& mesh_of(const Lot& lot) { return asset_.meshes[lot.mesh].mesh; }

  const Job& job_;
  const CompileSettings& settings_;
  Claims& claims_;
  const Progress& progress_;
  mesh::Asset asset_;
  bool plain_ = false;
  uint64_t source_hash_ = 0;
  std::vector<Lot> lots_;
  std::vector<Staged> staged_;
  uint64_t triangles_ = 0, triangles_done_ = 0;  // for the progress
  SourceReport report_;
};

Result<SourceReport> SourceBuild::run(const Fingerprint& known) {
  if (auto done = read(known); !done) return done.error();
  if (!keep_going(progress_, 0)) return Error{ErrorClass::interrupted, job_.input, "interrupted"};
  if (auto done = clean(); !done) return done.error();
  if (auto done = choose_lattices(); !done) return done.error();
  if (auto done = compile_all(); !done) return done.error();
  if (!keep_going(progress_, 1)) return Error{ErrorClass::interrupted, job_.input, "interrupted"};
  if (auto done = commit(); !done) return done.error();
  return std::move(report_);
}

Result<void> SourceBuild::read(const Fingerprint& known) {
  Timer timer;
  auto asset = mesh::read_asset(job_.input, {settings_.ambient_from_diffuse, progress_}, settings_.split);
  if (!asset) return asset.error();
  asset_ = std::move(*asset);
  plain_ = asset_.is_plain_mesh();
  report_.warnings = asset_.warnings;
  if (!plain_) {
    if (auto may = claims_.check_scene(job_.scene()); !may) return may;
  }
  std::vector<std::string> dependencies;
  for (const mesh::NamedMesh& named : asset_.meshes) {
    dependencies.insert(dependencies.end(), named.mesh.dependencies.begin(), named.mesh.dependencies.end());
  }
  auto whole = extended(job_.input, known, dependencies, progress_);
  if (!whole) return whole.error();
  source_hash_ = whole->hash;
  report_.files = std::move(whole->files);
  const double seconds = timer.seconds() / static_cast<double>(asset_.meshes.size());
  for (uint32_t i = 0; i < asset_.meshes.size(); ++i) {
    Lot& lot = lots_.emplace_back();
    lot.mesh = i;
    lot.where = plain_ ? job_.input : fmt::format("{}: mesh '{}'", job_.input, asset_.meshes[i].name);
    lot.report.seconds.read = seconds;
  }
  return {};
}

/// The rest of a source is compiled without a mesh that cannot be, if there is a rest.
Result<void> SourceBuild::set_aside(const Error& error) {
  const bool of_mesh = error.error_class == ErrorClass::mesh || error.error_class == ErrorClass::resource ||
                       error.error_class == ErrorClass::usage;
  if (!of_mesh) return error;
  report_.failed.push_back(error);
  if (report_.failed.size() == asset_.meshes.size()) return report_.failed.front();
  return {};
}

Result<void> SourceBuild::clean() {
  std::vector<Lot> kept;
  for (Lot& lot : lots_) {
    if (!keep_going(progress_, 0)) return Error{ErrorClass::interrupted, lot.where, "interrupted"};
    if (auto cleaned = clean_mesh(mesh_of(lot), lot.where, lot.report); !cleaned) {
      if (auto go_on = set_aside(cleaned.error()); !go_on) return go_on;
      continue;
    }
    lot.box = mesh::bounds(mesh_of(lot));
    triangles_ += mesh_of(lot).triangles.size();
    kept.push_back(std::move(lot));
  }
  lots_ = std::move(kept);
  return {};
}

/// The materials of what was one mesh share a lattice: where they met, they still do.
Result<void> SourceBuild::choose_lattices() {
  const auto are_one = [this](const Lot& a, const Lot& b) {
    return settings_.split == mesh::Split::material && asset_.meshes[a.mesh].whole == asset_.meshes[b.mesh].whole;
  };
  std::vector<Lot> kept;
  for (auto first = lots_.begin(); first != lots_.end();) {
    auto last = first + 1;
    while (last != lots_.end() && are_one(*first, *last)) ++last;
    if (auto chosen = choose_lattice({first, last}); !chosen) {
      for (const Lot& lot : std::span(first, last)) {
        if (auto go_on = set_aside({chosen.error().error_class, lot.where, chosen.error().what}); !go_on) return go_on;
      }
    } else {
      std::move(first, last, std::back_inserter(kept));
    }
    first = last;
  }
  lots_ = std::move(kept);
  return {};
}

/// For meshes on one lattice, and the places of their vertices on it: before any is split, so that no seam opens.
Result<void> SourceBuild::choose_lattice(std::span<Lot> lots) {
  Timer timer;
  std::vector<const mesh::Mesh*> meshes;
  for (const Lot& lot : lots) meshes.push_back(&mesh_of(lot));
  if (settings_.vertices == VertexForm::float32) {
    Box3d box;
    for (const Lot& lot : lots) box.extend(lot.box);
    for (Lot& lot : lots) lot.lattice = {box.lo, box.extent(), settings_.bits};
    return {};
  }
  const mesh::LatticeFit fit(meshes);
  const auto bits = choose_bits(meshes, fit);
  if (!bits) return bits.error();
  const double reach = settings_.max_error.value_or(std::numeric_limits<double>::infinity());
  const Lattice lattice = fit.lattice(*bits);
  for (size_t i = 0; i < lots.size(); ++i) {
    lots[i].lattice = lattice;
    lots[i].report.max_error = settings_.max_error;
    mesh_of(lots[i]).lattice_points = fit.place(i, lattice, reach);
  }
  const double seconds = timer.seconds() / static_cast<double>(lots.size());
  for (Lot& lot : lots) lot.report.seconds.normalise = seconds;
  return {};
}

Result<int> SourceBuild::choose_bits(std::span<const mesh::Mesh* const> meshes, const mesh::LatticeFit& fit) const {
  if (!settings_.max_error) return settings_.bits;
  if (const auto bits = fit.fewest_bits(*settings_.max_error)) return *bits;
  double least = 0;
  for (const mesh::Mesh* mesh : meshes)
    least = std::max(least, mesh::rounding_displacement(*mesh, fit.lattice(kMaxLatticeBits)));
  return Error{ErrorClass::usage, "",
               fmt::format("--max-error {} cannot be kept: {} bits move a vertex by {:.3g}; allow that or use --bits",
                           *settings_.max_error, kMaxLatticeBits, least)};
}

Result<void> SourceBuild::compile_all() {
  for (Lot& lot : lots_) {
    const size_t staged = staged_.size();
    mesh::Mesh mesh = std::move(mesh_of(lot));
    if (auto done = compile_fitting(lot, std::move(mesh), lot.report, false); !done) {
      while (staged_.size() > staged) {
        staged_.pop_back();
        report_.objects.pop_back();
      }
      if (auto go_on = set_aside(done.error()); !go_on) return go_on;
    } else if (lot.pieces > 0) {
      report_.notes.push_back(fmt::format("{} is too large for one object of {} bytes: split into {} objects",
                                          lot.where, settings_.max_object_size, lot.pieces));
    }
  }
  return {};
}

/// Whether a mesh seems to fit into one object. Where that is in doubt and building would take long, samples decide.
Result<bool> SourceBuild::seems_to_fit(const Lot& lot, const mesh::Mesh& mesh) {
  const SizeEstimate size = estimated_size(mesh, stored_vertex_bits(settings_.vertices, lot.lattice.bits));
  const uint64_t limit = settings_.max_object_size;
  if (size.rest + size.least_tree > limit) return false;
  if (size.rest + size.most_tree <= limit || mesh.triangles.size() < kWorthSampling) return true;
  const auto tree = sampled_tree_bytes(mesh, lot.lattice, settings_.tree, progress_);
  if (!tree) return Error{tree.error().error_class, lot.where, tree.error().what};
  return size.rest + *tree <= limit;
}

/// As one object if that is small enough, else in halves. What seemed to fit and is too large after all has been built
/// in vain.
Result<void> SourceBuild::compile_fitting(Lot& lot, mesh::Mesh mesh, CompileReport report, bool is_piece) {
  const Result<bool> fits = seems_to_fit(lot, mesh);
  if (!fits) return fits.error();
  if (*fits || mesh.triangles.size() == 1) {
    const uint64_t triangles = mesh.triangles.size();
    auto done = compile_one(lot, mesh, report, is_piece);
    const bool final = done || done.error().error_class != ErrorClass::resource || triangles == 1;
    if (final) triangles_done_ += triangles;
    if (final) return done;
  }
  return compile_halves(lot, std::move(mesh), std::move(report));
}

/// The first half takes over what the report says of the whole: how it was read, and what was dropped.
Result<void> SourceBuild::compile_halves(Lot& lot, mesh::Mesh mesh, CompileReport report) {
  if (auto may = claims_.check_scene(job_.scene()); !may) return may;
  auto halves = mesh::split_in_halves(mesh);
  mesh = {};
  report.source_triangles -= halves.second.triangles.size();
  const size_t before = lot.pieces;
  std::optional<Error> nothing_left;
  for (mesh::Mesh* half : {&halves.first, &halves.second}) {
    if (half == &halves.second) {
      report = {};
      report.source_triangles = half->triangles.size();
      report.max_error = lot.report.max_error;
    }
    report.topology = mesh::topology(*half);
    auto done = compile_fitting(lot, std::move(*half), report, true);
    if (!done && done.error().error_class != ErrorClass::mesh) return done;
    if (!done) nothing_left = done.error();  // all of this half collapsed, as some triangles of a whole mesh may
  }
  if (nothing_left && lot.pieces == before) return *nothing_left;
  return {};
}

Result<void> SourceBuild::compile_one(Lot& lot, const mesh::Mesh& mesh, CompileReport report, bool is_piece) {
  std::string name = plain_ ? "" : asset_.meshes[lot.mesh].name;
  if (is_piece) name += (plain_ ? "" : ".") + std::to_string(lot.pieces);
  const std::string path = name.empty() ? job_.object : job_.part(name);
  std::optional<Share> share;
  if (!name.empty()) share = Share{lot.mesh, asset_.meshes.size(), std::nullopt};
  if (is_piece) share->piece = lot.pieces;
  const ObjectTarget target{lot.where, path, lot.lattice, settings_.vertices,
                            provenance(job_, source_hash_, settings_, share)};
  const auto progress = [&](double done) {
    const double here = static_cast<double>(triangles_done_) + done * static_cast<double>(mesh.triangles.size());
    return keep_going(progress_, here / static_cast<double>(triangles_));
  };
  auto file = compile(mesh, target, settings_.tree, report, progress);
  if (!file) return file.error();
  if (report.bytes > settings_.max_object_size) {
    return Error{ErrorClass::resource, lot.where,
                 fmt::format("an object of {} triangle(s) takes {} bytes, more than --max-object-size allows",
                             report.triangles, report.bytes)};
  }
  report.output = path;
  report.mesh_name = name;
  lot.pieces += is_piece;
  staged_.push_back({std::move(*file), {name, path, lot.mesh, lot.box}});
  report_.objects.push_back(std::move(report));
  return {};
}

Result<void> SourceBuild::commit() {
  const bool is_object = staged_.size() == 1 && staged_.front().member.name.empty();
  if (!is_object) {
    std::vector<SceneMember> members;
    for (const Staged& staged : staged_) members.push_back(staged.member);
    const scene::Scene scene = asset_scene(asset_, job_.name(), members);
    report_.scene = job_.scene();
    report_.parts = scene.characters.front().parts.size();
    std::vector<std::string> outputs{report_.scene};
    for (const SceneMember& member : members) outputs.push_back(member.file);
    if (auto free = claims_.add(outputs); !free) return free;
    if (auto written = scene::write_scene(scene, report_.scene); !written) return written;
  }
  for (Staged& staged : staged_) {
    if (auto done = staged.file.commit(); !done) return done;
  }
  return {};
}

}  // namespace

Result<SourceReport> build_source(const Job& job, const Fingerprint& known, const CompileSettings& settings,
                                  Claims& claims, const Progress& progress) {
  return SourceBuild(job, settings, claims, progress).run(known);
}

Result<CompileReport> build_object(const std::string& input, const std::string& object, const CompileSettings& settings,
                                   const Progress& progress) {
  auto source = fingerprint(input, progress);
  if (!source) return source.error();
  Claims claims({{input}, {}});
  auto report = build_source({input, object}, *source, settings, claims, progress);
  if (!report) return report.error();
  if (report->objects.size() != 1 || !report->scene.empty())
    return Error{ErrorClass::mesh, input, "not one mesh but several: compile it with kdbuild"};
  return std::move(report->objects.front());
}

}  // namespace kd::tools
