// kdbench trace: rays against one object; from a file, or the shared ones made here from a camera. Its interface is how
// the project is compared with anything else: keep it stable (bench/README.md).
#include <algorithm>
#include <cstring>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "commands.h"
#include "common/console.h"
#include "common/layout.h"
#include "common/report.h"
#include "ray_options.h"
#include "sys/atomic_file.h"
#include "sys/hash.h"
#include "sys/parallel.h"
#include "triangle_test.h"

namespace kd::bench {

namespace {

using tools::Json;

struct Options : RayOptions {
  std::string object, rays, camera, size = "1920x1080", mode = "closest", test, layout = "expanded",
                                    scattered = "diffuse", hits, json;
};

Result<std::vector<render::RayRecord>> read_rays(const std::string& path) {
  auto file = MappedFile::open(path);
  if (!file) return file.error();
  const auto bytes = file->bytes();
  if (bytes.size() % sizeof(render::RayRecord) != 0) {
    return Error{ErrorClass::usage, path,
                 fmt::format("{} bytes are no whole number of rays, 32 bytes each", bytes.size())};
  }
  std::vector<render::RayRecord> rays(bytes.size() / sizeof(render::RayRecord));
  if (!rays.empty()) std::memcpy(rays.data(), bytes.data(), bytes.size());
  return rays;
}

/// What one class of rays came to.
Json result_json(const RayMeasurement& m, bool count_steps) {
  const std::vector<double>& seconds = m.outcome.seconds;
  Json j{{"class", m.name},
         {"mode", m.mode == RayMode::any ? "any" : "closest"},
         {"scattered", m.scattered},
         {"rays", m.rays},
         {"ray_hash", hash_text(m.ray_hash)},
         {"hits", m.hit_count},
         {"mean_t", m.mean_t},
         {"seconds",
          {{"median", m.seconds()},
           {"min", *std::min_element(seconds.begin(), seconds.end())},
           {"max", *std::max_element(seconds.begin(), seconds.end())}}},
         {"mrays_per_second", m.mrays_per_second()}};
  if (count_steps && m.rays > 0) {
    const auto a_ray = [&](uint64_t count) { return static_cast<double>(count) / static_cast<double>(m.rays); };
    const render::StepCounts& steps = m.outcome.steps;
    j["steps_per_ray"] = {
        {"nodes", a_ray(steps.nodes)}, {"leaves", a_ray(steps.leaves)}, {"triangles", a_ray(steps.triangles)}};
  }
  return j;
}

void print_result(const Json& j) {
  fmt::print("{:<8} {:>9} rays  {:>9} hits  mean t {:<11.6g} {:>10.2f} Mrays/s (median of runs)  hash {}\n",
             j["class"].get<std::string>(), j["rays"].get<uint64_t>(), j["hits"].get<uint64_t>(),
             j["mean_t"].get<double>(), j["mrays_per_second"].get<double>(), j["ray_hash"].get<std::string>());
  if (j.contains("steps_per_ray")) {
    const Json& s = j["steps_per_ray"];
    fmt::print("         {:.1f} nodes, {:.1f} leaves, {:.1f} triangles a ray\n", s["nodes"].get<double>(),
               s["leaves"].get<double>(), s["triangles"].get<double>());
  }
}

/// What is traced, and how.
struct Subject {
  render::Device device;
  nkd::ObjectFile object;
  render::TriangleTest test;

  bool in_packets(const Options& o) const {
    return o.effort.packets && test == render::TriangleTest::exact && device.backend->name == "cpu";
  }
};

/// The rays that the options ask for, traced: one class from a file, or the three shared ones.
struct Traced {
  std::vector<RayMeasurement> classes;
  std::optional<uint64_t> facing;  // shared rays only
};

Result<Traced> trace_file(const Options& o, const Subject& subject) {
  auto rays = read_rays(o.rays);
  if (!rays) return rays.error();
  const RayMode mode = o.mode == "any" ? RayMode::any : RayMode::closest;
  auto measured = measure_rays(subject.device, subject.object, "file", *rays, mode, subject.test, o.effort);
  if (!measured) return measured.error();
  Traced out;
  out.classes.push_back(std::move(*measured));
  return out;
}

Result<Traced> trace_shared(const Options& o, const Subject& subject, ImageSize size) {
  auto camera = read_camera(o.camera);
  if (!camera) return camera.error();
  SharedTrace shared(*camera, size);
  auto measured = shared.measure(subject.device, subject.object, subject.test, o.effort);
  if (!measured) return measured.error();
  Traced out{{}, shared.facing()};
  for (RayMeasurement& m : *measured) out.classes.push_back(std::move(m));
  return out;
}

Json report_json(const Options& o, const Subject& subject, const Traced& traced) {
  const size_t triangles = subject.object.geometry().triangle_count();
  const uint64_t bytes = traced.classes.back().outcome.device_bytes;
  Json j{{"version", 1},
         {"tool", tools::version_text()},
         {"object", o.object},
         {"triangles", triangles},
         {"vertex_form", kd::name_of(subject.object.geometry().form)},
         {"triangle_test", name_of(subject.test)},
         {"layout", name_of(o.effort.layout)},
         {"packets", subject.in_packets(o)},
         {"device", subject.device.description},
         {"warm_ups", o.effort.warm_ups},
         {"repeats", o.effort.repeats},
         {"device_bytes", bytes},
         {"device_bytes_per_triangle", static_cast<double>(bytes) / static_cast<double>(triangles)}};
  for (const RayMeasurement& m : traced.classes) j["results"].push_back(result_json(m, o.effort.count_steps));
  if (traced.facing) j["shadow_rays_facing_light"] = *traced.facing;
  return j;
}

void print_report(const Json& report) {
  for (const Json& result : report["results"]) print_result(result);
  fmt::print("object on the device: {} bytes, {:.1f} a triangle; layout: {}; vertices: {}, triangle test: {}\n",
             report["device_bytes"].get<uint64_t>(), report["device_bytes_per_triangle"].get<double>(),
             report["layout"].get<std::string>(), report["vertex_form"].get<std::string>(),
             report["triangle_test"].get<std::string>());
}

/// The hits of all classes, one after the other.
Result<void> write_hits(const std::string& path, const Traced& traced) {
  std::vector<render::HitRecord> hits;
  for (const RayMeasurement& m : traced.classes) hits.insert(hits.end(), m.outcome.hits.begin(), m.outcome.hits.end());
  return write_file(path, std::as_bytes(std::span(hits)));
}

Result<void> trace(const Options& o) {
  const ThreadLimit limit(o.threads);
  if (o.rays.empty() == o.camera.empty()) {
    return Error{ErrorClass::usage, "", "name a file of rays or --camera, one of the two (see kdbench trace --help)"};
  }
  auto size = parse_size(o.size);
  if (!size) return size.error();
  if (auto usable = tools::check_outputs({o.hits, o.json}, {o.object, o.rays, o.camera}); !usable) return usable;
  auto device = render::choose_device(o.device);
  if (!device) return device.error();
  auto object = nkd::ObjectFile::open(o.object);
  if (!object) return object.error();
  auto test = choose_triangle_test(o.test, *object);
  if (!test) return test.error();
  if (o.json != "-") fmt::print("{} on {}\n", o.object, device->description);

  const Subject subject{*device, std::move(*object), *test};
  auto traced = o.rays.empty() ? trace_shared(o, subject, *size) : trace_file(o, subject);
  if (!traced) return traced.error();
  const Json report = report_json(o, subject, *traced);
  if (o.json != "-") print_report(report);
  if (!o.hits.empty()) {
    if (auto written = write_hits(o.hits, *traced); !written) return written;
  }
  if (o.json.empty()) return {};
  return tools::write_report(o.json, report);
}

}  // namespace

Command trace_command(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* c = app.add_subcommand("trace", "Trace rays against one object");
  c->add_option("object", o->object, "A .nkd")->required();
  c->add_option("rays", o->rays, "Rays, model space: float32 ox oy oz tmin dx dy dz tmax, 32 bytes each");
  c->add_option("--camera", o->camera, "Make the shared rays instead: a camera file (13 numbers)");
  c->add_option("--size", o->size, "Pixels of the shared rays, WxH")->capture_default_str();
  c->add_option("--mode", o->mode, "closest or any, of a file of rays")
      ->check(CLI::IsMember({"closest", "any"}))
      ->capture_default_str();
  c->add_option("--triangle-test", o->test,
                triangle_test_names() +
                    ", the last two in float32, as baselines; by default exact, or woop for an "
                    "object of float32 vertices");
  add_ray_options(*c, *o);
  c->add_option("--layout", o->layout,
                "How triangles lie in memory: expanded, 48 bytes each, or compact, 12 and 8 a vertex")
      ->check(CLI::IsMember({"expanded", "compact"}))
      ->capture_default_str();
  c->add_flag("!--single-rays", o->effort.packets,
              "On the CPU, the exact test's rays one by one, as those of the other tests are, not in packets");
  c->add_option(
       "--scattered", o->scattered,
       "On CUDA, which of the exact test's rays have nothing to do with their neighbours, so that the lanes of a "
       "warp share the work of all its rays: none, the diffuse ones of the shared rays, or all")
      ->check(CLI::IsMember({"none", "diffuse", "all"}))
      ->capture_default_str();
  c->add_flag("--count", o->effort.count_steps, "Count nodes, leaves and triangles a ray (CPU)");
  c->add_option("--hits", o->hits, "Write the hits: float t, int32 primitive, float u, v, 16 bytes each");
  c->add_option("--json", o->json, "Write a JSON report to this file, or to stdout (-)");
  return {c, [o] {
            o->effort.layout = *tools::layout_named(o->layout);
            o->effort.scattered = o->scattered == "none"  ? Scattered::none
                                  : o->scattered == "all" ? Scattered::all
                                                          : Scattered::diffuse;
            const auto done = trace(*o);
            return done ? 0 : tools::fail(kKdbench, done.error());
          }};
}

}  // namespace kd::bench
