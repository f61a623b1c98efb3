// kdbench pareto: run time against error. Each mesh with float32 vertices under the usual triangle tests, and on
// lattices of so many bits with the exact one; all against the mesh as the file has it, in double precision.
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "commands.h"
#include "common/console.h"
#include "machine.h"
#include "pareto/report.h"
#include "ray_options.h"
#include "scratch_folder.h"
#include "sys/atomic_file.h"
#include "sys/parallel.h"

namespace kd::bench {

namespace {

namespace fs = std::filesystem;

/// Meshes that have cameras, where a checkout has meshes beside it.
constexpr const char* kDefaultFolder = "../shared/data";
constexpr const char* kDefaultMeshes[] = {"sibenik", "sponza", "bunny", "dragon_res2", "staircase", "living_room"};

struct Options : RayOptions {
  std::vector<std::string> meshes;
  std::string cameras, size = "960x540", json, csv;
  std::vector<int> bits{10, 12, 16, 18, 21, 24};
};

std::string camera_of(const Options& o, const fs::path& mesh) {
  const fs::path folder = o.cameras.empty() ? mesh.parent_path() / "cameras" : fs::path(o.cameras);
  return (folder / mesh.stem()).string() + ".txt";
}

/// The meshes named, or those of the default ones that are there.
std::vector<std::string> meshes_of(const Options& o) {
  if (!o.meshes.empty()) return o.meshes;
  std::vector<std::string> found;
  for (const char* name : kDefaultMeshes) {
    const std::string mesh = fmt::format("{}/{}.ply", kDefaultFolder, name);
    std::error_code ignored;
    if (fs::exists(mesh, ignored)) {
      found.push_back(mesh);
    } else {
      tools::warn(kKdbench, fmt::format("{} is not there{}: skipped", mesh,
                                        fs::exists(mesh + ".xz", ignored) ? " (unpack its .xz and name it)" : ""));
    }
  }
  return found;
}

Result<void> write_outputs(const Options& o, const Circumstances& circumstances, std::span<const MeshResult> results) {
  if (!o.csv.empty()) {
    if (auto written = write_file(o.csv, csv_table(circumstances, results).csv()); !written) return written;
  }
  if (o.json.empty()) return {};
  return tools::write_report(o.json, pareto_json(circumstances, results));
}

Result<void> pareto(const Options& o) {
  const ThreadLimit limit(o.threads);
  tools::catch_interrupts();
  auto size = parse_size(o.size);
  if (!size) return size.error();
  const std::vector<std::string> meshes = meshes_of(o);
  if (meshes.empty()) return Error{ErrorClass::missing, kDefaultFolder, "has no mesh to measure: name one"};
  std::vector<std::string> inputs = meshes;
  for (const std::string& mesh : meshes) inputs.push_back(camera_of(o, mesh));
  if (auto usable = tools::check_outputs({o.json, o.csv}, inputs); !usable) return usable;
  auto device = render::choose_device(o.device);
  if (!device) return device.error();
  auto scratch = ScratchFolder::create();
  if (!scratch) return scratch.error();

  const Machine machine = this_machine();
  const ParetoEffort effort{o.effort.warm_ups, o.effort.repeats};
  const Circumstances circumstances{
      device->description, machine.processor, thread_count(), machine.compiler, *size, effort};
  const bool text = o.json != "-";
  if (text) {
    fmt::print(
        "{}, {}, {} threads, {}; {}; Mrays/s, medians of {} rounds; depth and Hausdorff in steps of 21 bits, "
        "normals in degrees\n",
        device->description, machine.processor, thread_count(), machine.compiler, o.size, effort.rounds);
  }
  std::vector<MeshResult> results;
  for (const std::string& mesh : meshes) {
    std::fflush(stdout);
    auto result = measure_mesh({mesh, camera_of(o, mesh), *size}, forms_of(o.bits), effort, *device, scratch->path(),
                               tools::progress_bar(mesh, !text));
    if (!result) return result.error();
    results.push_back(std::move(*result));
    if (text) fmt::print("\n{}", markdown(results.back()));
    if (o.csv.empty()) continue;
    if (auto written = write_file(o.csv, csv_table(circumstances, results).csv()); !written) return written;
  }
  return write_outputs(o, circumstances, results);
}

}  // namespace

Command pareto_command(CLI::App& app) {
  auto o = std::make_shared<Options>();
  o->effort = {1, 5, false};
  CLI::App* c = app.add_subcommand("pareto", "Measure run time against error, fixed-point against floating-point");
  c->add_option("meshes", o->meshes,
                fmt::format("Meshes, as kdbuild reads them; those of {} that have cameras by default", kDefaultFolder));
  c->add_option("--cameras", o->cameras, "Folder with MESH.txt for each MESH.ply; cameras/ beside each by default");
  c->add_option("--bits", o->bits, "Lattice bits an axis: B,B,...")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(tools::whole_number(kMinLatticeBits, kMaxLatticeBits))
      ->capture_default_str();
  c->add_option("--size", o->size, "Pixels of the shared rays, WxH")->capture_default_str();
  add_ray_options(*c, *o);
  c->add_option("--csv", o->csv, "Write a row a mesh and form to this file; it grows mesh by mesh");
  c->add_option("--json", o->json, "Write a JSON report to this file, or to stdout (-)");
  return {c, [o] {
            const auto done = pareto(*o);
            return done ? 0 : tools::fail(kKdbench, done.error());
          }};
}

}  // namespace kd::bench
