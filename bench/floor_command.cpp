// kdbench floor: two numbers first, operations and bytes. What rays have to do, what the chip can do, how fast the rays
// could be by either alone, and how fast they are.
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "commands.h"
#include "common/console.h"
#include "floor/report.h"
#include "ray_options.h"
#include "sys/parallel.h"

namespace kd::bench {

namespace {

namespace fs = std::filesystem;
using floors::ClassResult;
using floors::ObjectResult;
using tools::Json;

struct Options : RayOptions {
  std::vector<std::string> objects;
  std::string cameras, size = "1920x1080", json;
};

std::string camera_of(const Options& o, const std::string& object) {
  return (fs::path(o.cameras) / fs::path(object).stem()).string() + ".txt";
}

/// Measures one class and counts its work; the hits go to `hits` if that is not null.
Result<void> add_class(const Options& o, const render::Device& device, const nkd::ObjectFile& object, const char* name,
                       std::span<const render::RayRecord> rays, RayMode mode, ObjectResult& result,
                       std::vector<render::HitRecord>* hits = nullptr) {
  auto measured = measure_rays(device, object, name, rays, mode, render::TriangleTest::exact, o.effort);
  if (!measured) return measured.error();
  result.device_bytes = measured->outcome.device_bytes;
  result.classes.push_back(
      {name, mode, rays.size(), floors::count_work(object, rays, mode), median(measured->outcome.seconds)});
  if (hits) *hits = std::move(measured->outcome.hits);
  return {};
}

/// The three shared classes (shared_rays.h).
Result<ObjectResult> measure_object(const Options& o, const render::Device& device, ImageSize size,
                                    const std::string& path) {
  auto object = nkd::ObjectFile::open(path);
  if (!object) return object.error();
  if (object->geometry().form != VertexForm::lattice) {
    return Error{ErrorClass::object, path,
                 "its vertices are float32; what is counted is the exact test on the lattice"};
  }
  auto camera = read_camera(camera_of(o, path));
  if (!camera) return camera.error();
  ObjectResult result{path, object->geometry().triangle_count(), 0, {}, {}};
  const PrimaryRays primary = primary_rays(*camera, size.width, size.height);
  std::vector<render::HitRecord> hits;
  if (auto done = add_class(o, device, *object, "primary", primary.rays, RayMode::closest, result, &hits); !done)
    return done.error();
  const SecondaryRays secondary = secondary_rays(*object, *camera, primary, hits);
  if (auto done = add_class(o, device, *object, "shadow", secondary.shadow, RayMode::any, result); !done)
    return done.error();
  if (auto done = add_class(o, device, *object, "diffuse", secondary.diffuse, RayMode::closest, result); !done)
    return done.error();
  if (device.backend->name != "cuda") return result;
  auto loads = floors::measure_loads(device.index, result.device_bytes);
  if (!loads) return loads.error();
  result.loads = *loads;
  return result;
}

void print_tables(const std::vector<ObjectResult>& objects, const std::optional<floors::ChipRates>& chip) {
  if (chip) fmt::print("{}\n", chip_table(*chip));
  fmt::print("A ray on average:\n\n{}\n", work_table(objects));
  if (chip) {
    fmt::print("Mrays/s if this alone were the limit, and measured:\n\n{}", floor_table(objects, *chip));
    return;
  }
  for (const ObjectResult& object : objects) {
    for (const ClassResult& c : object.classes) {
      if (c.rays == 0) continue;
      fmt::print("{} {}: {:.2f} Mrays/s\n", object.object, c.name, 1e-6 * static_cast<double>(c.rays) / c.seconds);
    }
  }
  fmt::print("No floor for a CPU: instructions are counted in the CUDA kernel, and rates measured on CUDA devices.\n");
}

Result<void> measure(const Options& o) {
  const ThreadLimit limit(o.threads);
  auto size = parse_size(o.size);
  if (!size) return size.error();
  if (auto usable = tools::check_outputs({o.json}, o.objects); !usable) return usable;
  auto device = render::choose_device(o.device);
  if (!device) return device.error();
  if (o.json != "-") {
    fmt::print("On {}, {} x {}, medians of {}\n\n", device->description, size->width, size->height, o.effort.repeats);
  }
  std::optional<floors::ChipRates> chip;
  if (device->backend->name == "cuda") {
    auto measured = floors::measure_chip(device->index);
    if (!measured) return measured.error();
    chip = *measured;
  }
  std::vector<ObjectResult> objects;
  for (const std::string& path : o.objects) {
    auto result = measure_object(o, *device, *size, path);
    if (!result) return result.error();
    objects.push_back(std::move(*result));
  }
  if (o.json != "-") print_tables(objects, chip);
  if (o.json.empty()) return {};
  Json report{{"version", 1},
              {"tool", tools::version_text()},
              {"device", device->description},
              {"width", size->width},
              {"height", size->height},
              {"warm_ups", o.effort.warm_ups},
              {"repeats", o.effort.repeats}};
  add_results(report, objects, chip);
  return tools::write_report(o.json, report);
}

}  // namespace

Command floor_command(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* c = app.add_subcommand("floor", "What rays cost in instructions and bytes, and how fast they could be");
  c->add_option("objects", o->objects, ".nkd files")->required();
  c->add_option("--cameras", o->cameras, "Folder with NAME.txt, a camera file, for each NAME.nkd")->required();
  c->add_option("--size", o->size, "Pixels of the shared rays, WxH")->capture_default_str();
  add_ray_options(*c, *o);
  c->add_option("--json", o->json, "Write a JSON report to this file, or to stdout (-)");
  return {c, [o] {
            const auto done = measure(*o);
            return done ? 0 : tools::fail(kKdbench, done.error());
          }};
}

}  // namespace kd::bench
