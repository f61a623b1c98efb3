#include "stress/plan.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "stress/embree_peer.h"
#include "sys/hash.h"

namespace kd::stress {

namespace {

constexpr ClassRow kClassRows[] = {
    {RayClass::vertices, "vertices", "at every vertex"},
    {RayClass::edges, "edges", "at every edge's midpoint"},
    {RayClass::faces, "faces", "at face interiors"},
    {RayClass::exact, "exact", "at vertices and midpoints, exactly"},
    {RayClass::planes, "planes", "lying in split planes"},
    {RayClass::grid, "grid", "parallel to an axis, through lattice points"},
    {RayClass::grazing, "grazing", "in a triangle's plane, or nearly"},
    {RayClass::along, "along", "along edges, from vertex to vertex"},
    {RayClass::near_axis, "near-axis", "nearly parallel to an axis"},
    {RayClass::far_away, "far", "from 10^3 to 10^9 sizes away"},
    {RayClass::segments, "segments", "ending at, before or behind a surface"},
    {RayClass::inside, "inside", "from inside closed meshes, at vertices and edges"},
    {RayClass::model, "model", "float32 rays of model space"},
    {RayClass::frames, "frames", "through far, tiny, huge, mirrored, sheared, uneven frames"},
    {RayClass::shadow, "shadow", "shadow rays as the renderer makes them"},
    {RayClass::contact, "contact", "shadow rays across a gap of one lattice step"},
};
static_assert(std::size(kClassRows) == kRayClasses);

/// A mesh to be compiled at one number of bits.
struct Source {
  const ShapeRow* shape = nullptr;
  std::string name;  // kOffsetBall, or a file's path
  int bits = 0;
  double weight = 1;
  std::vector<RayClass> classes;

  std::string mesh() const { return shape ? std::string(shape->name) : name; }
};

Result<StressCase> make(const Source& s) {
  if (s.shape) return make_case(*s.shape, s.bits);
  return s.name == kOffsetBall ? make_offset_ball(s.bits) : make_case(s.name, s.bits);
}

template <class Rows>
std::string names_of(const Rows& rows) {
  std::string names;
  for (const auto& row : rows) names += fmt::format("{}{}", names.empty() ? "" : ", ", row.name);
  return names;
}

Error unknown(const std::string& option, const std::string& name, const std::string& names) {
  return {ErrorClass::usage, fmt::format("{} {}", option, name), "there are " + names};
}

bool chosen(const std::vector<std::string>& names, std::string_view name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

Result<void> check_names(const StressSettings& s) {
  for (const std::string& name : s.classes) {
    const bool known =
        std::any_of(std::begin(kClassRows), std::end(kClassRows), [&](auto& r) { return r.name == name; });
    if (!known) return unknown("--class", name, class_names());
  }
  for (const std::string& name : s.meshes) {
    const auto rows = shape_rows();
    const bool known = std::any_of(rows.begin(), rows.end(), [&](auto& r) { return r.name == name; });
    if (!known && name != kOffsetBall && name != "none") return unknown("--mesh", name, mesh_names());
  }
  return {};
}

/// The sources with a class of those chosen, fewest bits first.
std::vector<Source> sources_of(const StressSettings& s) {
  std::vector<Source> all;
  const auto add = [&](Source source, bool inside, bool sheets) {
    for (const ClassRow& row : kClassRows) {
      if (!chosen(s.classes, row.name)) continue;
      if (row.ray_class == RayClass::inside && !inside) continue;
      if (row.ray_class == RayClass::contact && (!sheets || source.bits > kContactBits)) continue;
      source.classes.push_back(row.ray_class);
    }
    if (!source.classes.empty()) all.push_back(std::move(source));
  };
  for (const int bits : s.bits) {
    for (const ShapeRow& row : shape_rows()) {
      if (chosen(s.meshes, row.name)) add({&row, "", bits, row.weight, {}}, row.inside, row.sheets);
    }
    if (chosen(s.meshes, kOffsetBall)) add({nullptr, std::string(kOffsetBall), bits, 0.5, {}}, true, false);
    for (const std::string& file : s.files) add({nullptr, file, bits, 1, {}}, false, false);
  }
  return all;
}

/// The rays that a job has before all are shared out.
uint64_t fixed_rays(const StressSettings& s, const Source& source, RayClass ray_class) {
  if (s.rays < kRaysForAll || source.bits != kDefaultLatticeBits || ray_class != RayClass::inside) return 0;
  return source.mesh() == "ball" ? kBallRays : source.mesh() == "box" ? kBoxRays : 0;
}

/// Deals out rays in proportion to weights, to the last one.
class Dealer {
 public:
  Dealer(uint64_t rays, double weights) : rays_(static_cast<double>(rays)), weights_(weights) {}
  uint64_t deal(double weight) {
    dealt_weight_ += weight;
    const auto until = static_cast<uint64_t>(std::llround(rays_ * std::min(1.0, dealt_weight_ / weights_)));
    const uint64_t share = until - dealt_;
    dealt_ = until;
    return share;
  }

 private:
  double rays_, weights_, dealt_weight_ = 0;
  uint64_t dealt_ = 0;
};

/// A job's random numbers: the same wherever the mesh lies, and whatever else is run.
uint64_t seed_of(const StressSettings& s, const Source& source, RayClass ray_class) {
  const std::string name = fmt::format("{} {} {} {}", s.seed, std::filesystem::path(source.mesh()).stem().string(),
                                       source.bits, static_cast<uint32_t>(ray_class));
  return hash_bytes(name.data(), name.size());
}

/// Runs jobs at one case, on whichever device.
class Runner {
 public:
  static Result<Runner> create(const StressCase& stress_case, const render::Device& device) {
    Runner runner(stress_case);
    if (device.backend->name == "cuda") {
      auto uploaded = CudaCase::upload(stress_case, device.index);
      if (!uploaded) return uploaded.error();
      runner.cuda_.emplace(std::move(*uploaded));
    } else {
      auto peer = embree_peer(stress_case);
      if (!peer) return peer.error();
      runner.peer_ = std::move(*peer);
    }
    return runner;
  }
  Result<JobResult> run(const Job& job) const {
    return cuda_ ? cuda_->run(job) : Result<JobResult>(run_on_cpu(*case_, job, peer_.get()));
  }
  /// So many rays at once take a fraction of a second, mostly.
  uint64_t piece() const { return cuda_ ? uint64_t{1} << 24 : uint64_t{1} << 16; }

 private:
  explicit Runner(const StressCase& stress_case) : case_(&stress_case) {}
  const StressCase* case_;
  std::optional<CudaCase> cuda_;
  std::unique_ptr<Peer> peer_;
};

/// Counts rays done, for the progress.
struct Advance {
  const Progress& progress;
  double total;
  uint64_t done = 0;
  bool go_on() const { return keep_going(progress, static_cast<double>(done) / total); }
};

Result<StressRow> run_row(const Runner& runner, Job job, StressRow row, Advance& advance) {
  const uint64_t end = job.first + job.rays;
  while (job.first < end) {
    if (!advance.go_on()) return Error{ErrorClass::interrupted, "", "interrupted"};
    job.rays = std::min(runner.piece(), end - job.first);
    auto result = runner.run(job);
    if (!result) return result.error();
    row.tally.add(result->tally);
    row.seconds += result->seconds;
    for (const Failure& f : result->failures) {
      if (row.failures.size() < kMostFailures) row.failures.push_back(f);
    }
    job.first += job.rays;
    advance.done += job.rays;
  }
  return row;
}

/// Of the rays' oracles, so many look at every triangle that it adds about four triangles a ray.
uint32_t plain_every(const StressCase& c) { return std::max(1u, static_cast<uint32_t>(c.triangles.size() / 4)); }

}  // namespace

std::span<const ClassRow> class_rows() { return kClassRows; }
std::string class_names() { return names_of(class_rows()); }
std::string mesh_names() { return fmt::format("{}, {}", names_of(shape_rows()), kOffsetBall); }

Result<std::vector<StressRow>> run_stress(const StressSettings& settings, const render::Device& device,
                                          const Progress& progress) {
  if (auto known = check_names(settings); !known) return known.error();
  const std::vector<Source> sources = sources_of(settings);
  if (sources.empty()) return Error{ErrorClass::usage, "", "no mesh has rays of the classes that were named"};
  double weights = 0;
  uint64_t fixed = 0;
  for (const Source& source : sources) {
    weights += source.weight;
    for (const RayClass ray_class : source.classes) fixed += fixed_rays(settings, source, ray_class);
  }

  std::vector<StressRow> rows;
  Dealer dealer(settings.rays - fixed, weights);
  Advance advance{progress, static_cast<double>(settings.rays)};
  for (const Source& source : sources) {
    auto stress_case = make(source);
    if (!stress_case) return stress_case.error();
    auto runner = Runner::create(*stress_case, device);
    if (!runner) return runner.error();
    for (const RayClass ray_class : source.classes) {
      const uint64_t share = dealer.deal(source.weight / static_cast<double>(source.classes.size()));
      const uint64_t rays = share + fixed_rays(settings, source, ray_class);
      if (rays == 0) continue;
      const Job job{ray_class,    seed_of(settings, source, ray_class), settings.first, rays, plain_every(*stress_case),
                    settings.test};
      auto row = run_row(*runner, job,
                         {source.mesh(), source.bits, ray_class, stress_case->triangles.size(), 0, {}, {}}, advance);
      if (!row) return row.error();
      rows.push_back(std::move(*row));
    }
  }
  return rows;
}

}  // namespace kd::stress
