// kdbench sweep: one mesh built with many settings, and the shared rays traced through each tree: a row of figures a
// setting. Rows are printed as they are known and the CSV file grows with them, so that a run cut short is not lost.
#include <memory>

#include <fmt/format.h>

#include "commands.h"
#include "common/console.h"
#include "kdbuild/build_source.h"
#include "ray_options.h"
#include "scratch_folder.h"
#include "sweep_check.h"
#include "sweep_settings.h"
#include "sys/atomic_file.h"
#include "sys/parallel.h"
#include "table.h"

namespace kd::bench {

namespace {

struct Options : RayOptions {
  std::string mesh, camera, size = "1920x1080", csv;
  SweepLists lists;
};

Table empty_table() {
  return Table({"costs", "bonus", "price", "depth", "SAH cost", "refs/tri", "nodes/tri", "deepest", ".nkd B/tri",
                "device B/tri", "build s", "primary", "shadow", "bounce"},
               8);
}

std::vector<std::string> row(const SweepPoint& point, const tools::CompileReport& r,
                             const std::array<RayMeasurement, 3>& rays) {
  const auto a_triangle = [&](uint64_t count) { return static_cast<double>(count) / static_cast<double>(r.triangles); };
  const auto speed = [](const RayMeasurement& m) { return fmt::format("{:.2f}", m.mrays_per_second()); };
  return {point.costs,
          point.bonus,
          point.price,
          point.depth,
          fmt::format("{:.2f}", r.tree.sah_cost),
          fmt::format("{:.2f}", a_triangle(r.references)),
          fmt::format("{:.2f}", a_triangle(r.tree.inner_nodes + r.tree.leaves)),
          fmt::format("{}", r.tree.depth),
          fmt::format("{:.1f}", a_triangle(r.bytes)),
          fmt::format("{:.1f}", a_triangle(rays[0].outcome.device_bytes)),
          fmt::format("{:.3f}", r.seconds.build),
          speed(rays[0]),
          speed(rays[1]),
          speed(rays[2])};
}

Result<void> sweep(const Options& o) {
  const ThreadLimit limit(o.threads);
  tools::catch_interrupts();
  auto size = parse_size(o.size);
  if (!size) return size.error();
  auto points = sweep_points(o.lists);
  if (!points) return points.error();
  if (auto usable = tools::check_outputs({o.csv}, {o.mesh, o.camera}); !usable) return usable;
  auto device = render::choose_device(o.device);
  if (!device) return device.error();
  auto camera = read_camera(o.camera);
  if (!camera) return camera.error();
  auto scratch = ScratchFolder::create();
  if (!scratch) return scratch.error();

  fmt::print("{}: built on {} threads; {}, {}, Mrays/s, median of {}; SAH cost at 1 : 1.5\n\n", o.mesh, thread_count(),
             device->description, o.size, o.effort.repeats);
  SharedTrace shared(*camera, *size);
  Table table = empty_table();
  HitCheck check;
  fmt::print("{}", table.head());
  for (const SweepPoint& point : *points) {
    std::fflush(stdout);
    const std::string object_path = scratch->file("object.nkd");
    tools::CompileSettings settings;
    settings.tree = point.settings;
    auto report = tools::build_object(o.mesh, object_path, settings, tools::progress_bar("", true));
    if (!report) return report.error();
    auto object = nkd::ObjectFile::open(object_path);
    if (!object) return object.error();
    auto rays = shared.measure(*device, *object, render::TriangleTest::exact, o.effort);
    if (!rays) return rays.error();
    table.add(row(point, *report, *rays));
    fmt::print("{}", table.last_row());
    if (!o.csv.empty()) {
      if (auto written = write_file(o.csv, table.csv()); !written) return written;
    }
    if (auto same = check.add({(*rays)[0].hit_count, (*rays)[1].hit_count, (*rays)[2].hit_count}, o.mesh); !same)
      return same;
  }
  fmt::print("\n{}\n", check.verdict());
  return {};
}

}  // namespace

Command sweep_command(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* c = app.add_subcommand("sweep", "Build a mesh with many settings and trace the shared rays through each");
  c->add_option("mesh", o->mesh, "A mesh, as kdbuild reads it")->required();
  c->add_option("--camera", o->camera, "The camera of the shared rays (13 numbers)")->required();
  c->add_option("--size", o->size, "Pixels of the shared rays, WxH")->capture_default_str();
  const auto add_list = [c](const char* name, std::vector<std::string>& values, const char* what) {
    c->add_option(name, values, what)->delimiter(',')->allow_extra_args(false)->capture_default_str();
  };
  add_list("--costs", o->lists.costs, "Costs of a traversal step and a triangle test: T:I,T:I,...");
  add_list("--bonus", o->lists.bonuses, "Shares of a split's cost forgiven where it cuts off empty space: B,B,...");
  add_list("--price", o->lists.prices, "SAH costs that a byte a triangle is worth: P,P,...");
  add_list("--depth", o->lists.depths, "Depth limits, in inner nodes: N,N,...");
  add_ray_options(*c, *o);
  c->add_option("--csv", o->csv, "Write the rows to this file too, as CSV")->check(tools::file_name());
  return {c, [o] {
            const auto done = sweep(*o);
            return done ? 0 : tools::fail(kKdbench, done.error());
          }};
}

}  // namespace kd::bench
