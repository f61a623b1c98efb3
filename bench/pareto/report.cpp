#include "pareto/report.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "common/console.h"
#include "triangle_test.h"

namespace kd::bench {

namespace {

using tools::Json;

std::string mesh_name(const MeshResult& mesh) { return std::filesystem::path(mesh.mesh).stem().string(); }

const FormResult* find(const MeshResult& mesh, const Form& wanted) {
  for (const FormResult& f : mesh.forms) {
    if (f.form.vertices == wanted.vertices && f.form.bits == wanted.bits && f.form.test == wanted.test) return &f;
  }
  return nullptr;
}

constexpr Form kFloatMt{VertexForm::float32, kMaxLatticeBits, render::TriangleTest::moller_trumbore};
constexpr Form kFloatWoop{VertexForm::float32, kMaxLatticeBits, render::TriangleTest::woop};
constexpr Form kDefault{VertexForm::lattice, kDefaultLatticeBits, render::TriangleTest::exact};
constexpr Form kDefaultMt{VertexForm::lattice, kDefaultLatticeBits, render::TriangleTest::moller_trumbore};
constexpr Form kDefaultWoop{VertexForm::lattice, kDefaultLatticeBits, render::TriangleTest::woop};

/// One spread over another, kind by kind.
struct SpreadRatio {
  double median, p99, rms;
};
SpreadRatio operator/(const Spread& a, const Spread& b) {
  const auto ratio = [](double x, double y) { return y > 0 ? x / y : 0; };
  return {ratio(a.median, b.median), ratio(a.p99, b.p99), ratio(a.rms, b.rms)};
}

/// How fast one is in terms of the other: the median over the rounds, in each of which the two ran soon after another.
double speed_ratio(const std::vector<double>& seconds, const std::vector<double>& other) {
  std::vector<double> ratios;
  for (size_t round = 0; round < seconds.size(); ++round) ratios.push_back(other[round] / seconds[round]);
  return median(std::move(ratios));
}

/// What the default bits are to the baselines; nothing where they were not among the forms.
struct Ratios {
  std::array<double, 3> speed_to_mt, speed_to_woop;  // exact over float test, the same object, by ray class
  struct {
    const char* name;
    SpreadRatio ratio;
  } depth[4];  // over that of float32 vertices
};

std::optional<Ratios> ratios(const MeshResult& mesh) {
  const FormResult* ours = find(mesh, kDefault);
  const FormResult *ours_mt = find(mesh, kDefaultMt), *ours_woop = find(mesh, kDefaultWoop);
  const FormResult *mt = find(mesh, kFloatMt), *woop = find(mesh, kFloatWoop);
  if (!ours || !ours_mt || !ours_woop || !mt || !woop) return std::nullopt;
  const Spread& depth = ours->hits.depth;
  Ratios out{{},
             {},
             {{"moller_trumbore", depth / mt->hits.depth},
              {"woop", depth / woop->hits.depth},
              {"model_space_moller_trumbore", depth / mesh.model_space.moller_trumbore},
              {"model_space_woop", depth / mesh.model_space.woop}}};
  for (size_t c = 0; c < 3; ++c) {
    out.speed_to_mt[c] = speed_ratio(ours->seconds[c], ours_mt->seconds[c]);
    out.speed_to_woop[c] = speed_ratio(ours->seconds[c], ours_woop->seconds[c]);
  }
  return out;
}

Json spread_json(const Spread& s, double unit = 1) {
  return {{"median", s.median / unit}, {"p99", s.p99 / unit}, {"rms", s.rms / unit}, {"max", s.max / unit}};
}

Json form_json(const MeshResult& mesh, const FormResult& f) {
  Json speed;
  for (size_t c = 0; c < 3; ++c) speed[kRayClasses[c]] = f.mrays_per_second[c];
  const HitErrors& h = f.hits;
  return {{"name", f.form.name()},
          {"vertices", kd::name_of(f.form.vertices)},
          {"bits", f.form.bits},
          {"triangle_test", name_of(f.form.test)},
          {"triangles", f.triangles},
          {"bytes", {{"file", f.file_bytes}, {"vertices", f.vertex_bytes}, {"device", f.device_bytes}}},
          {"mrays_per_second", speed},
          {"primary_hits",
           {{"pixels", h.pixels},
            {"reference_hits", h.reference_hits},
            {"missed", h.missed},
            {"false", h.false_hits},
            {"wrong_primitive", h.wrong},
            {"coincident", h.coincident},
            {"same", h.same}}},
          {"depth_error", spread_json(h.depth)},
          {"depth_error_steps_21", spread_json(h.depth, mesh.step(21))},
          {"depth_error_steps", spread_json(h.depth, mesh.step(f.form.bits))},
          {"depth_error_relative", spread_json(h.relative_depth)},
          {"normal_error_degrees", spread_json(h.normal)},
          {"image_error", {{"rmse", f.rmse}, {"flip", f.flip}}},
          {"surface_error",
           {{"hausdorff", f.surface.distance()},
            {"hausdorff_steps_21", f.surface.distance() / mesh.step(21)},
            {"to_form", f.surface.to_form},
            {"to_source", f.surface.to_source},
            {"samples", f.surface.samples},
            {"max_displacement", f.max_displacement}}},
          {"aimed_rays",
           {{"rays", f.fans.rays}, {"missed", f.fans.missed}, {"counted_twice", f.fans.twice}, {"leaks", f.leaks}}}};
}

Json ratios_json(const Ratios& r) {
  const auto by_class = [](const std::array<double, 3>& values) {
    Json j;
    for (size_t c = 0; c < 3; ++c) j[kRayClasses[c]] = values[c];
    return j;
  };
  Json depth;
  for (const auto& d : r.depth)
    depth[d.name] = {{"median", d.ratio.median}, {"p99", d.ratio.p99}, {"rms", d.ratio.rms}};
  return {{"exact_speed_to_moller_trumbore", by_class(r.speed_to_mt)},
          {"exact_speed_to_woop", by_class(r.speed_to_woop)},
          {"depth_error_to_float32", depth}};
}

double a_triangle(uint64_t bytes, const FormResult& f) {
  return static_cast<double>(bytes) / static_cast<double>(f.triangles);
}

std::string ratios_text(const Ratios& r) {
  const auto speeds = [](const std::array<double, 3>& s) {
    return fmt::format("{:.3f} / {:.3f} / {:.3f}", s[0], s[1], s[2]);
  };
  const auto depths = [](const SpreadRatio& d) {
    return fmt::format("{:.2f} / {:.2f} / {:.2f}", d.rms, d.p99, d.median);
  };
  return fmt::format(
      "\nB {} on its own object, Mrays/s primary / shadow / diffuse: exact / Moller-Trumbore {}, exact / Woop {}.\n"
      "Its depth error over that of float32 vertices, RMS / 99 % / median: Moller-Trumbore {}, Woop {}; "
      "in model space Moller-Trumbore {}, Woop {}.\n",
      kDefaultLatticeBits, speeds(r.speed_to_mt), speeds(r.speed_to_woop), depths(r.depth[0].ratio),
      depths(r.depth[1].ratio), depths(r.depth[2].ratio), depths(r.depth[3].ratio));
}

}  // namespace

std::string markdown(const MeshResult& mesh) {
  Table table({mesh_name(mesh), "primary", "shadow", "diffuse", ".nkd B/tri", "device B/tri", "missed", "false",
               "wrong prim", "depth rms", "depth max", "normal rms", "RMSE", "FLIP", "Hausdorff", "aimed", "aim missed",
               "aim twice", "leaks"});
  for (const FormResult& f : mesh.forms) {
    const auto speed = [&](size_t c) { return fmt::format("{:.2f}", f.mrays_per_second[c]); };
    const auto count = [](uint64_t n) { return fmt::format("{}", n); };
    table.add({f.form.name(), speed(0), speed(1), speed(2), fmt::format("{:.1f}", a_triangle(f.file_bytes, f)),
               fmt::format("{:.1f}", a_triangle(f.device_bytes, f)), count(f.hits.missed), count(f.hits.false_hits),
               count(f.hits.wrong), fmt::format("{:.3g}", f.hits.depth.rms / mesh.step(21)),
               fmt::format("{:.3g}", f.hits.depth.max / mesh.step(21)), fmt::format("{:.2g}", f.hits.normal.rms),
               fmt::format("{:.2g}", f.rmse), fmt::format("{:.2g}", f.flip),
               fmt::format("{:.3g}", f.surface.distance() / mesh.step(21)), count(f.fans.rays), count(f.fans.missed),
               count(f.fans.twice), count(f.leaks)});
  }
  const auto r = ratios(mesh);
  return table.markdown() + (r ? ratios_text(*r) : "");
}

Table csv_table(const Circumstances& circumstances, std::span<const MeshResult> meshes) {
  Table table({"mesh",
               "device",
               "form",
               "vertices",
               "bits",
               "triangle_test",
               "width",
               "height",
               "triangles",
               "file_bytes",
               "vertex_bytes",
               "device_bytes",
               "primary_mrays",
               "shadow_mrays",
               "diffuse_mrays",
               "pixels",
               "reference_hits",
               "missed",
               "false",
               "wrong_primitive",
               "coincident",
               "same",
               "depth_median_steps21",
               "depth_p99_steps21",
               "depth_rms_steps21",
               "depth_max_steps21",
               "depth_rms_steps",
               "depth_max_steps",
               "depth_rms_relative",
               "depth_max_relative",
               "normal_rms_degrees",
               "normal_max_degrees",
               "rmse",
               "flip",
               "hausdorff",
               "hausdorff_steps21",
               "max_displacement",
               "aimed_rays",
               "aimed_missed",
               "aimed_twice",
               "leaks",
               "model_space_mt_depth_rms_steps21",
               "model_space_woop_depth_rms_steps21",
               "exact_to_mt_primary",
               "exact_to_mt_shadow",
               "exact_to_mt_diffuse"});
  for (const MeshResult& mesh : meshes) {
    const auto r = ratios(mesh);
    const auto exactness = [&](size_t c) { return r ? fmt::format("{:.4f}", r->speed_to_mt[c]) : ""; };
    for (const FormResult& f : mesh.forms) {
      const HitErrors& h = f.hits;
      const auto real = [](double v) { return fmt::format("{:.7g}", v); };
      const auto whole = [](uint64_t v) { return fmt::format("{}", v); };
      const auto speed = [&](size_t c) { return fmt::format("{:.6g}", f.mrays_per_second[c]); };
      const double step21 = mesh.step(21), step = mesh.step(f.form.bits);
      table.add({mesh_name(mesh),
                 circumstances.device,
                 f.form.name(),
                 kd::name_of(f.form.vertices),
                 fmt::format("{}", f.form.bits),
                 name_of(f.form.test),
                 whole(circumstances.size.width),
                 whole(circumstances.size.height),
                 whole(f.triangles),
                 whole(f.file_bytes),
                 whole(f.vertex_bytes),
                 whole(f.device_bytes),
                 speed(0),
                 speed(1),
                 speed(2),
                 whole(h.pixels),
                 whole(h.reference_hits),
                 whole(h.missed),
                 whole(h.false_hits),
                 whole(h.wrong),
                 whole(h.coincident),
                 whole(h.same),
                 real(h.depth.median / step21),
                 real(h.depth.p99 / step21),
                 real(h.depth.rms / step21),
                 real(h.depth.max / step21),
                 real(h.depth.rms / step),
                 real(h.depth.max / step),
                 real(h.relative_depth.rms),
                 real(h.relative_depth.max),
                 real(h.normal.rms),
                 real(h.normal.max),
                 real(f.rmse),
                 real(f.flip),
                 real(f.surface.distance()),
                 real(f.surface.distance() / step21),
                 real(f.max_displacement),
                 whole(f.fans.rays),
                 whole(f.fans.missed),
                 whole(f.fans.twice),
                 whole(f.leaks),
                 real(mesh.model_space.moller_trumbore.rms / step21),
                 real(mesh.model_space.woop.rms / step21),
                 exactness(0),
                 exactness(1),
                 exactness(2)});
    }
  }
  return table;
}

Json pareto_json(const Circumstances& c, std::span<const MeshResult> meshes) {
  Json j{{"version", 1},
         {"tool", tools::version_text()},
         {"device", c.device},
         {"processor", c.processor},
         {"threads", c.threads},
         {"compiler", c.compiler},
         {"width", c.size.width},
         {"height", c.size.height},
         {"warm_ups", c.effort.warm_ups},
         {"rounds", c.effort.rounds},
         {"meshes", Json::array()}};
  for (const MeshResult& mesh : meshes) {
    Json rays, forms = Json::array();
    for (size_t i = 0; i < 3; ++i) rays[kRayClasses[i]] = mesh.rays[i];
    for (const FormResult& f : mesh.forms) forms.push_back(form_json(mesh, f));
    Json m{{"mesh", mesh.mesh},
           {"camera", mesh.camera},
           {"triangles", mesh.triangles},
           {"diagonal", mesh.diagonal},
           {"step_21", mesh.step(21)},
           {"rays", rays},
           {"model_space_depth_error_steps_21",
            {{"moller_trumbore", spread_json(mesh.model_space.moller_trumbore, mesh.step(21))},
             {"woop", spread_json(mesh.model_space.woop, mesh.step(21))}}},
           {"forms", forms}};
    if (const auto r = ratios(mesh)) m["ratios"] = ratios_json(*r);
    j["meshes"].push_back(std::move(m));
  }
  return j;
}

}  // namespace kd::bench
