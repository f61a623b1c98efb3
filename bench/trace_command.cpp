// kdbench trace: rays against one object; from a file, or the shared ones made here from a camera. Its interface is how
// the project is compared with anything else: keep it stable (bench/README.md).
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "commands.h"
#include "common/console.h"
#include "common/report.h"
#include "render/backend.h"
#include "shared_rays.h"
#include "sys/atomic_file.h"
#include "sys/hash.h"
#include "sys/parallel.h"

namespace kd::bench {

namespace {

using tools::Json;

struct Options {
  std::string object, rays, camera, size = "1920x1080", mode = "closest", device = "auto", hits, json;
  unsigned threads = 0;
  int repeat = 10;
  int warm_ups = 3;
  bool count_steps = false;
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

constexpr uint64_t kMostPixels = uint64_t{1} << 26;  // three classes of rays and their hits: 10 GiB

struct Size {
  uint32_t width = 0, height = 0;
};

std::optional<Size> parse_size(const std::string& text) {
  Size size;
  const char* end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.width);
  if (width.ec != std::errc{} || width.ptr == end || *width.ptr != 'x') return {};
  const auto height = std::from_chars(width.ptr + 1, end, size.height);
  if (height.ec != std::errc{} || height.ptr != end) return {};
  const uint64_t pixels = uint64_t{size.width} * size.height;
  const bool fits = size.width <= 65536 && size.height <= 65536 && pixels >= 1 && pixels <= kMostPixels;
  return fits ? std::optional(size) : std::nullopt;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  return n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

/// What one class of rays came to.
Json result_json(const char* name, const render::TraceJob& job, const render::TraceOutcome& outcome) {
  uint64_t hits = 0;
  double sum_t = 0;
  for (const render::HitRecord& hit : outcome.hits) {
    if (hit.primitive < 0) continue;
    ++hits;
    sum_t += hit.t;
  }
  const double seconds = median(outcome.seconds);
  const auto count = static_cast<double>(job.rays.size());
  Json j{{"class", name},
         {"mode", job.mode == RayMode::any ? "any" : "closest"},
         {"rays", job.rays.size()},
         {"ray_hash", hash_text(ray_hash(job.rays))},
         {"hits", hits},
         {"mean_t", hits ? sum_t / static_cast<double>(hits) : 0},
         {"seconds",
          {{"median", seconds},
           {"min", *std::min_element(outcome.seconds.begin(), outcome.seconds.end())},
           {"max", *std::max_element(outcome.seconds.begin(), outcome.seconds.end())}}},
         {"mrays_per_second", count / seconds * 1e-6}};
  if (job.count_steps && count > 0) {
    j["steps_per_ray"] = {{"nodes", static_cast<double>(outcome.steps.nodes) / count},
                          {"leaves", static_cast<double>(outcome.steps.leaves) / count},
                          {"triangles", static_cast<double>(outcome.steps.triangles) / count}};
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

class TraceRun {
 public:
  TraceRun(const Options& options, nkd::ObjectFile object, render::Device device)
      : options_(options), object_(std::move(object)), device_(std::move(device)) {
    report_ = {{"version", 1},
               {"tool", tools::version_text()},
               {"object", options.object},
               {"triangles", object_.geometry().triangle_count()},
               {"device", device_.description},
               {"warm_ups", options.warm_ups},
               {"repeats", options.repeat}};
  }

  /// Traces one class of rays and adds what came of it to the report.
  Result<std::vector<render::HitRecord>> trace(const char* name, std::span<const render::RayRecord> rays,
                                               RayMode mode) {
    const render::TraceJob job{rays, mode, options_.warm_ups, options_.repeat, options_.count_steps};
    auto outcome = device_.backend->trace(object_, job, device_.index);
    if (!outcome) return outcome.error();
    report_["device_bytes"] = outcome->device_bytes;
    report_["device_bytes_per_triangle"] =
        static_cast<double>(outcome->device_bytes) / static_cast<double>(object_.geometry().triangle_count());
    const Json result = result_json(name, job, *outcome);
    if (options_.json != "-") print_result(result);
    report_["results"].push_back(result);
    return std::move(outcome->hits);
  }

  Result<std::vector<render::HitRecord>> trace_file() {
    auto rays = read_rays(options_.rays);
    if (!rays) return rays.error();
    return trace("file", *rays, options_.mode == "any" ? RayMode::any : RayMode::closest);
  }

  /// The three shared classes; the hits of all of them, one after the other.
  Result<std::vector<render::HitRecord>> trace_shared(Size size) {
    auto camera = read_camera(options_.camera);
    if (!camera) return camera.error();
    const PrimaryRays primary = primary_rays(*camera, size.width, size.height);
    auto hits = trace("primary", primary.rays, RayMode::closest);
    if (!hits) return hits;
    const SecondaryRays secondary = secondary_rays(object_, *camera, primary, *hits);
    report_["shadow_rays_facing_light"] = secondary.facing;
    auto shadow = trace("shadow", secondary.shadow, RayMode::any);
    if (!shadow) return shadow;
    auto diffuse = trace("diffuse", secondary.diffuse, RayMode::closest);
    if (!diffuse) return diffuse;
    hits->insert(hits->end(), shadow->begin(), shadow->end());
    hits->insert(hits->end(), diffuse->begin(), diffuse->end());
    return hits;
  }

  void print_bytes() const {
    fmt::print("object on the device: {} bytes, {:.1f} a triangle\n", report_["device_bytes"].get<uint64_t>(),
               report_["device_bytes_per_triangle"].get<double>());
  }
  const Json& report() const { return report_; }

 private:
  const Options& options_;
  nkd::ObjectFile object_;
  render::Device device_;
  Json report_;
};

Result<void> trace(const Options& o) {
  const ThreadLimit limit(o.threads);
  if (o.rays.empty() == o.camera.empty()) {
    return Error{ErrorClass::usage, "", "name a file of rays or --camera, one of the two (see kdbench trace --help)"};
  }
  const std::optional<Size> size = parse_size(o.size);
  if (!size)
    return Error{ErrorClass::usage, "--size " + o.size, "not a size such as 1920x1080, of at most 2^26 pixels"};
  if (auto usable = tools::check_outputs({o.hits, o.json}, {o.object, o.rays, o.camera}); !usable) return usable;
  auto device = render::choose_device(o.device);
  if (!device) return device.error();
  auto object = nkd::ObjectFile::open(o.object);
  if (!object) return object.error();
  if (o.json != "-") fmt::print("{} on {}\n", o.object, device->description);

  TraceRun run(o, std::move(*object), std::move(*device));
  auto hits = o.rays.empty() ? run.trace_shared(*size) : run.trace_file();
  if (!hits) return hits.error();
  if (o.json != "-") run.print_bytes();
  if (!o.hits.empty()) {
    if (auto written = write_file(o.hits, std::as_bytes(std::span(*hits))); !written) return written;
  }
  if (o.json.empty()) return {};
  return tools::write_report(o.json, run.report());
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
  c->add_option("--device", o->device, "auto, cpu, cuda or cuda:N")->capture_default_str();
  c->add_option("--threads", o->threads, "CPU threads; 0: all cores")
      ->check(tools::whole_number(0, 4096))
      ->capture_default_str();
  c->add_option("--repeat", o->repeat, "Timed runs")->check(tools::whole_number(1, 100000))->capture_default_str();
  c->add_option("--warm-up", o->warm_ups, "Untimed runs before them")
      ->check(tools::whole_number(0, 1000))
      ->capture_default_str();
  c->add_flag("--count", o->count_steps, "Count nodes, leaves and triangles a ray (CPU)");
  c->add_option("--hits", o->hits, "Write the hits: float t, int32 primitive, float u, v, 16 bytes each");
  c->add_option("--json", o->json, "Write a JSON report to this file, or to stdout (-)");
  return {c, [o] {
            const auto done = trace(*o);
            return done ? 0 : tools::fail(kKdbench, done.error());
          }};
}

}  // namespace kd::bench
