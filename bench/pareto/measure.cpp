#include "pareto/measure.h"

#include <algorithm>
#include <map>
#include <memory>

#include <fmt/format.h>

#include "kdbuild/build_source.h"
#include "mesh/clean.h"
#include "mesh/lattice_fit.h"
#include "mesh/read_mesh.h"
#include "pareto/flip.h"
#include "triangle_test.h"

namespace kd::bench {

namespace {

/// The mesh as the source has it: what all forms are held against.
struct Truth {
  mesh::Mesh mesh;
  ReferenceTracer tracer;
  std::vector<uint32_t> triangle_of;  // source primitive -> triangle of the mesh
  View view;
  ReferenceRender render;
  Targets targets;

  CornersOf corners() const {
    return [this](int64_t primitive) { return tracer.triangles()[triangle_of[static_cast<size_t>(primitive)]]; };
  }
};

std::vector<Corners> corners_of(const mesh::Mesh& mesh) {
  std::vector<Corners> corners;
  corners.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    corners.push_back({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
  return corners;
}

/// The targets that the camera sees clearly on the source mesh.
Targets clear_targets(const Truth& truth) {
  Targets targets = find_targets(truth.mesh);
  Corners corners;
  const CornersOf corners_of = truth.corners();
  const auto aimed =
      aim(targets, truth.view.camera.position, truth.view.diagonal, [&](uint32_t primitive) -> const Corners* {
        corners = corners_of(primitive);
        return &corners;
      });
  std::vector<Target> clear;
  for (const AimedRay& a : aimed) clear.push_back(targets.all[a.target]);
  targets.all = std::move(clear);
  return targets;
}

Result<Truth> find_truth(const ParetoSubject& subject) {
  auto camera = read_camera(subject.camera);
  if (!camera) return camera.error();
  auto read = mesh::read_mesh(subject.mesh, {});
  if (!read) return read.error();
  mesh::clean(*read);
  if (read->triangles.empty()) return Error{ErrorClass::mesh, subject.mesh, "no triangle of it has an area"};
  std::vector<Corners> corners = corners_of(*read);
  Truth truth{std::move(*read), ReferenceTracer(std::move(corners)), {}, {}, {}, {}};
  const std::vector<uint32_t>& sources = truth.mesh.source_primitives;
  truth.triangle_of.resize(sources.back() + size_t{1});
  for (uint32_t i = 0; i < sources.size(); ++i) truth.triangle_of[sources[i]] = i;
  truth.view = {*camera, subject.size.width, subject.size.height, length(mesh::bounds(truth.mesh).extent()),
                primary_rays(*camera, subject.size.width, subject.size.height)};
  truth.render = render_reference(truth.view, truth.tracer, sources);
  truth.targets = clear_targets(truth);
  return truth;
}

/// One object: a way to store vertices. Forms that differ in the triangle test share it.
struct Object {
  nkd::ObjectFile file;
  ObjectTriangles triangles;
  double max_displacement;
  Hausdorff surface;

  Object(nkd::ObjectFile opened, double displacement)
      : file(std::move(opened)), triangles(file), max_displacement(displacement) {}
};

/// The object's surface against the source's.
Hausdorff surface_error(const Truth& truth, const ObjectTriangles& object, uint64_t parts) {
  const std::vector<uint32_t>& sources = truth.mesh.source_primitives;
  std::vector<Corners> corners;
  std::vector<uint32_t> form_of(sources.size(), kNoTriangle), source_of;
  for (uint32_t i = 0; i < sources.size(); ++i) {
    if (object.index_of(sources[i]) == kNoTriangle) continue;
    form_of[i] = static_cast<uint32_t>(corners.size());
    corners.push_back(object.corners(sources[i]));
    source_of.push_back(i);
  }
  const ReferenceTracer form(std::move(corners));
  const auto of_source = [&](uint32_t i) {
    return form_of[i] == kNoTriangle ? nullptr : &form.triangles()[form_of[i]];
  };
  const auto of_form = [&](uint32_t i) { return &truth.tracer.triangles()[source_of[i]]; };
  return hausdorff({truth.tracer, of_source}, {form, of_form}, parts);
}

using Objects = std::map<std::pair<VertexForm, int>, std::unique_ptr<Object>>;

Result<Objects> compile_objects(const ParetoSubject& subject, const Truth& truth, const std::vector<Form>& forms,
                                const ParetoEffort& effort, const std::string& scratch, const Progress& progress) {
  Objects objects;
  for (const Form& form : forms) {
    auto& object = objects[{form.vertices, form.bits}];
    if (object) continue;
    const std::string path = fmt::format("{}/{}-{}.nkd", scratch, kd::name_of(form.vertices), form.bits);
    tools::CompileSettings settings;
    settings.bits = form.bits;
    settings.vertices = form.vertices;
    auto report = tools::build_object(subject.mesh, path, settings, progress);
    if (!report) return report.error();
    auto file = nkd::ObjectFile::open(path);
    if (!file) return file.error();
    object = std::make_unique<Object>(std::move(*file), report->max_displacement);
    object->surface = surface_error(truth, object->triangles, effort.surface_parts);
  }
  return objects;
}

/// A device with one form of the mesh on it.
struct Tracer {
  const render::Device& device;
  const nkd::ObjectFile& object;
  render::TriangleTest test;

  Result<RayMeasurement> trace(const char* name, std::span<const render::RayRecord> rays, RayMode mode,
                               int warm_ups = 0) const {
    // One by one on the CPU: the tests in float32 have no packets.
    return measure_rays(device, object, name, rays, mode, test, {.warm_ups = warm_ups, .repeats = 1, .packets = false});
  }
};

/// The picture that the form gives, its own shadow rays traced with it.
Result<Picture> picture(const Truth& truth, const Tracer& tracer, std::span<const render::HitRecord> hits,
                        const CornersOf& corners) {
  const SecondaryRays rays = secondary_rays(corners, truth.view.diagonal, truth.view.camera, truth.view.primary, hits);
  auto shadow = tracer.trace("shadow", rays.shadow, RayMode::any);
  if (!shadow) return shadow.error();
  std::vector<uint8_t> lit;
  for (const render::HitRecord& hit : shadow->outcome.hits) lit.push_back(hit.primitive < 0);
  return shade(truth.view, hits, corners, lit);
}

Result<void> measure_fans(const Truth& truth, const Tracer& tracer, const ObjectTriangles& triangles, FormResult& out) {
  Corners corners;
  const auto find = [&](uint32_t primitive) -> const Corners* {
    if (triangles.index_of(primitive) == kNoTriangle) return nullptr;
    corners = triangles.corners(primitive);
    return &corners;
  };
  const std::vector<AimedRay> aimed = aim(truth.targets, truth.view.camera.position, truth.view.diagonal, find);
  out.fans = count_fans(truth.targets, aimed, tracer.object, tracer.test);
  std::vector<render::RayRecord> rays;
  for (const AimedRay& a : aimed) rays.push_back(a.ray);
  auto traced = tracer.trace("fans", rays, RayMode::closest);
  if (!traced) return traced.error();
  for (size_t i = 0; i < aimed.size(); ++i) {
    const render::HitRecord& hit = traced->outcome.hits[i];
    out.leaks += hit.primitive < 0 || static_cast<double>(hit.t) > aimed[i].t_behind;
  }
  return {};
}

Result<FormResult> measure_errors(const Truth& truth, const Form& form, const Object& object,
                                  const render::Device& device) {
  const Tracer tracer{device, object.file, form.test};
  FormResult out;
  out.form = form;
  out.triangles = object.file.geometry().triangle_count();
  out.file_bytes = object.file.size();
  out.vertex_bytes = object.file.geometry().vertices.size_bytes();
  out.max_displacement = object.max_displacement;
  out.surface = object.surface;
  auto primary = tracer.trace("primary", truth.view.primary.rays, RayMode::closest);
  if (!primary) return primary.error();
  out.device_bytes = primary->outcome.device_bytes;
  const CornersOf corners = [&](int64_t primitive) { return object.triangles.corners(primitive); };
  out.hits = hit_errors(truth.view, truth.render, primary->outcome.hits, {truth.corners(), corners});
  auto shown = picture(truth, tracer, primary->outcome.hits, corners);
  if (!shown) return shown.error();
  out.rmse = rmse(truth.render.picture, *shown);
  out.flip = flip(to_srgb8(truth.render.picture), to_srgb8(*shown));
  if (auto done = measure_fans(truth, tracer, object.triangles, out); !done) return done.error();
  return out;
}

/// All forms on the same rays, in turns, so that what else the machine does falls on all alike. Each round begins with
/// another form.
Result<void> measure_speed(const Truth& truth, const Objects& objects, const ParetoEffort& effort,
                           const render::Device& device, const Progress& progress, MeshResult& out) {
  const std::array<std::span<const render::RayRecord>, 3> rays{truth.view.primary.rays, truth.render.secondary.shadow,
                                                               truth.render.secondary.diffuse};
  for (size_t round = 0; round < static_cast<size_t>(effort.rounds); ++round) {
    for (size_t c = 0; c < rays.size(); ++c) {
      for (size_t turn = 0; turn < out.forms.size(); ++turn) {
        if (!keep_going(progress, static_cast<double>(round) / effort.rounds))
          return Error{ErrorClass::interrupted, "", "interrupted"};
        FormResult& f = out.forms[(round + turn) % out.forms.size()];
        const Tracer tracer{device, objects.at({f.form.vertices, f.form.bits})->file, f.form.test};
        auto m = tracer.trace(kRayClasses[c], rays[c], c == 1 ? RayMode::any : RayMode::closest, effort.warm_ups);
        if (!m) return m.error();
        f.seconds[c].push_back(m->seconds());
      }
    }
  }
  for (size_t c = 0; c < rays.size(); ++c) {
    out.rays[c] = rays[c].size();
    for (FormResult& f : out.forms)
      f.mrays_per_second[c] = static_cast<double>(rays[c].size()) / median(f.seconds[c]) * 1e-6;
  }
  return {};
}

}  // namespace

std::string Form::name() const {
  const char* test_name = test == render::TriangleTest::exact             ? "exact"
                          : test == render::TriangleTest::moller_trumbore ? "MT"
                                                                          : "Woop";
  return vertices == VertexForm::float32       ? fmt::format("float32 {}", test_name)
         : test == render::TriangleTest::exact ? fmt::format("B {}", bits)
                                               : fmt::format("B {} {}", bits, test_name);
}

std::vector<Form> forms_of(const std::vector<int>& bits) {
  std::vector<Form> forms{{VertexForm::float32, kMaxLatticeBits, render::TriangleTest::moller_trumbore},
                          {VertexForm::float32, kMaxLatticeBits, render::TriangleTest::woop}};
  for (int b : bits) {
    forms.push_back({VertexForm::lattice, b, render::TriangleTest::exact});
    if (b != kDefaultLatticeBits) continue;
    for (const auto test : {render::TriangleTest::moller_trumbore, render::TriangleTest::woop})
      forms.push_back({VertexForm::lattice, b, test});
  }
  return forms;
}

Result<MeshResult> measure_mesh(const ParetoSubject& subject, const std::vector<Form>& forms,
                                const ParetoEffort& effort, const render::Device& device, const std::string& scratch,
                                const Progress& progress) {
  auto truth = find_truth(subject);
  if (!truth) return truth.error();
  auto objects = compile_objects(subject, *truth, forms, effort, scratch, progress);
  if (!objects) return objects.error();
  const Vec3d extent = mesh::bounds(truth->mesh).extent();
  MeshResult out;
  out.mesh = subject.mesh;
  out.camera = subject.camera;
  out.triangles = truth->mesh.triangles.size();
  out.diagonal = truth->view.diagonal;
  out.longest = std::max({extent.x, extent.y, extent.z});
  out.model_space = model_space_depth(truth->view, truth->render, truth->corners());
  for (const Form& form : forms) {
    if (!keep_going(progress, 0)) return Error{ErrorClass::interrupted, "", "interrupted"};
    auto result = measure_errors(*truth, form, *objects->at({form.vertices, form.bits}), device);
    if (!result) return result.error();
    out.forms.push_back(std::move(*result));
  }
  if (auto done = measure_speed(*truth, *objects, effort, device, progress, out); !done) return done.error();
  return out;
}

}  // namespace kd::bench
