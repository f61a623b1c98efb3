// kdbench stress: the contract that every ray meets a surface exactly once, proven on rays made to break it.
#include <memory>

#include <fmt/format.h>

#include "commands.h"
#include "common/console.h"
#include "stress_report.h"
#include "sys/parallel.h"
#include "sys/timer.h"
#include "triangle_test.h"

namespace kd::bench {

namespace {

struct Options {
  stress::StressSettings settings;
  std::string device = "auto", test = "exact";
  unsigned threads = 0;
  std::string json;
  bool quiet = false;
};

Result<stress::Tally> stress_all(const Options& o) {
  tools::catch_interrupts();
  const ThreadLimit limit(o.threads);
  if (auto usable = tools::check_outputs({o.json}, o.settings.files); !usable) return usable.error();
  auto device = render::choose_device(o.device);
  if (!device) return device.error();
  auto test = triangle_test_named(o.test);
  if (!test) return test.error();
  StressRun run;
  run.settings = o.settings;
  run.settings.test = *test;
  run.device = device->description;
  if (device->backend->name == "cpu") run.threads = thread_count();
  const bool text = o.json != "-";
  if (text) {
    fmt::print("{} rays, seed {}, triangle test: {}, on {}\n\n", o.settings.rays, o.settings.seed, o.test,
               device->description);
  }

  Timer timer;
  auto rows = run_stress(run.settings, *device, tools::progress_bar("stress", o.quiet));
  if (!rows) return rows.error();
  run.rows = std::move(*rows);
  run.seconds = timer.seconds();
  if (text) print_stress(run);
  if (!o.json.empty()) {
    if (auto written = tools::write_report(o.json, stress_json(run)); !written) return written.error();
  }
  return total_of(run);
}

}  // namespace

Command stress_command(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* c =
      app.add_subcommand("stress", "Rays made to leak, against exact integers: exit status 1 if any goes wrong");
  stress::StressSettings& s = o->settings;
  c->add_option("meshes", s.files, "Mesh files to aim at, too, as kdbuild reads them");
  c->add_option("--rays", s.rays, "Rays in all")
      ->check(tools::whole_number(1, int64_t{1} << 50))
      ->capture_default_str();
  c->add_option("--device", o->device, "auto, cpu, cuda or cuda:N")->capture_default_str();
  c->add_option("--class", s.classes, "A class of rays; may be repeated. All: " + stress::class_names())
      ->allow_extra_args(false);
  c->add_option("--mesh", s.meshes, "A mesh made here, or none; may be repeated. All: " + stress::mesh_names())
      ->allow_extra_args(false);
  c->add_option("--bits", s.bits, "Lattice bits, a list")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(tools::whole_number(stress::kStressBits.front(), kMaxLatticeBits))
      ->capture_default_str();
  c->add_option("--triangle-test", o->test,
                triangle_test_names() + ", the last two in float32, as baselines: they fail")
      ->capture_default_str();
  c->add_option("--seed", s.seed, "Of the random numbers")->capture_default_str();
  c->add_option("--first", s.first, "Number of the first ray of every class and mesh: to trace a ray again")
      ->capture_default_str();
  c->add_option("--threads", o->threads, "CPU threads; 0: all cores")
      ->check(tools::whole_number(0, 4096))
      ->capture_default_str();
  c->add_option("--json", o->json, "Write a JSON report to this file, or to stdout (-)");
  c->add_flag("--quiet", o->quiet, "No progress bar");
  return {c, [o] {
            const auto tally = stress_all(*o);
            if (!tally) return tools::fail(kKdbench, tally.error());
            return tally->faults() > 0 ? 1 : 0;
          }};
}

}  // namespace kd::bench
