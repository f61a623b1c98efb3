#include "kdbuild/freshness.h"

#include <charconv>
#include <filesystem>
#include <set>

#include <fmt/format.h>

#include "common/console.h"
#include "nkd/object_file.h"
#include "scene/parse_scene.h"

namespace kd::tools {

namespace {

namespace fs = std::filesystem;

constexpr const char* kNone = "there is no output";

/// Takes `text` off the front of `from`, or a number; false if it is not there.
bool take(std::string_view& from, std::string_view text) {
  if (!from.starts_with(text)) return false;
  from.remove_prefix(text.size());
  return true;
}
bool take(std::string_view& from, size_t& number) {
  const auto parsed = std::from_chars(from.data(), from.data() + from.size(), number);
  from.remove_prefix(static_cast<size_t>(parsed.ptr - from.data()));
  return parsed.ec == std::errc{};
}

/// The share that a source name speaks of; nothing if it is not of this source.
std::optional<Share> share_of(std::string_view recorded, std::string_view source) {
  Share share;
  if (!take(recorded, source)) return std::nullopt;
  if (recorded.empty()) return share;
  const bool named = take(recorded, ", mesh ") && take(recorded, share.mesh) && take(recorded, " of ") &&
                     take(recorded, share.meshes) && share.mesh-- > 0;
  if (!named) return std::nullopt;
  return share;
}

CompileReport report_of(const nkd::ObjectFile& file) {
  const nkd::Summary& s = file.summary();
  const nkd::Geometry& g = file.geometry();
  CompileReport report;
  report.output = file.path();
  report.up_to_date = true;
  report.triangles = g.triangle_count();
  report.vertices = g.vertex_count();
  report.lattice = s.lattice;
  report.vertex_form = g.form;
  report.max_displacement = s.max_displacement;
  report.rms_displacement = s.rms_displacement;
  report.tree = s.tree;
  report.references = g.references.size();
  report.bytes = file.size();
  return report;
}

class Judge {
 public:
  Judge(const Job& job, uint64_t source_hash, const CompileSettings& settings)
      : job_(job), max_error_(settings.max_error), expected_(provenance(job, source_hash, settings, std::nullopt)) {}

  Freshness object() {
    const std::optional<Share> share = take_object(job_.object, "");
    if (share && share->meshes != 1) out_.stale = "the source changed";
    return std::move(out_);
  }

  Freshness scene() {
    out_.scene = job_.scene();
    const auto scene = scene::read_scene(out_.scene);
    if (!scene) return stale("the scene cannot be read");
    std::set<size_t> found;
    size_t meshes = 1;
    for (const scene::SceneObject& object : scene->objects) {
      if (!is_ours(object.file)) return {kNone, {}, ""};
      const std::optional<Share> share = take_object(object.file, object.name);
      if (!share) return std::move(out_);
      found.insert(share->mesh);
      meshes = share->meshes;
    }
    if (found.size() != meshes) return stale("some of its meshes have no object");
    return std::move(out_);
  }

 private:
  Freshness stale(const char* why) {
    out_.stale = why;
    return std::move(out_);
  }

  /// Adds an object to those that are up to date and returns which it is, or says why it is not one.
  std::optional<Share> take_object(const std::string& path, const std::string& name) {
    const auto file = nkd::ObjectFile::open(path);
    const auto stale = [this](std::string why) {
      out_.stale = std::move(why);
      return std::nullopt;
    };
    if (!file || !file->check_attributes().empty())
      return stale(fs::exists(path) ? "the output is no sound object" : "an output is missing");
    const nkd::Provenance& p = file->summary().provenance;
    const std::optional<Share> share = share_of(p.source_name, expected_.source_name);
    if (!share || p.source_hash != expected_.source_hash) return stale("the source changed");
    if (p.settings != expected_.settings) return stale(fmt::format("the settings changed: they were {}", p.settings));
    if (p.writer != expected_.writer) return stale(fmt::format("it was made by {}", p.writer));
    out_.objects.push_back(report_of(*file));
    out_.objects.back().mesh_name = name;
    out_.objects.back().max_error = max_error_;
    return share;
  }

  bool is_ours(const std::string& object) const {
    const fs::path base = job_.base(), file = object;
    return file.parent_path() == base.parent_path() &&
           file.filename().string().starts_with(base.filename().string() + ".");
  }

  const Job& job_;
  std::optional<double> max_error_;
  nkd::Provenance expected_;
  Freshness out_;
};

}  // namespace

nkd::Provenance provenance(const Job& job, uint64_t source_hash, const CompileSettings& settings,
                           const std::optional<Share>& share) {
  std::string name = fs::path(job.input).filename().string();
  if (share) name += fmt::format(", mesh {} of {}", share->mesh + 1, share->meshes);
  if (share && share->piece) name += fmt::format(", piece {}", *share->piece + 1);
  return {name, source_hash, settings_text(settings), version_text()};
}

Freshness freshness(const Job& job, uint64_t source_hash, const CompileSettings& settings) {
  Freshness of_object{kNone, {}, ""};
  if (fs::exists(job.object)) of_object = Judge(job, source_hash, settings).object();
  if (of_object.stale.empty() || !fs::exists(job.scene())) return of_object;
  return Judge(job, source_hash, settings).scene();
}

}  // namespace kd::tools
