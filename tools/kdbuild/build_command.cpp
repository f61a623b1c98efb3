// kdbuild build: meshes in, objects out, and an account of what was done to each.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "common/console.h"
#include "kdbuild/batch.h"
#include "kdbuild/build_report.h"
#include "kdbuild/commands.h"
#include "kdbuild/depfile.h"
#include "kdbuild/explain_report.h"
#include "mesh/read_mesh.h"
#include "sys/atomic_file.h"
#include "sys/parallel.h"
#include "sys/timer.h"

namespace kd::tools {

namespace {

struct Options {
  std::vector<std::string> inputs;
  std::string output, stats, depfile;
  std::optional<int> bits;
  CompileSettings settings;
  unsigned jobs = 1, threads = 0;
  bool force = false, dry_run = false, explain = false, quiet = false;
};

std::string plot_of(const std::string& object) {
  return std::filesystem::path(object).replace_extension(".svg").string();
}

/// All files that are read or written, as far as can be known before the sources are read.
Neighbours neighbours(const std::vector<Item>& items, const Options& options) {
  Neighbours all{{}, {options.stats, options.depfile}};
  for (const Item& item : items) {
    all.inputs.push_back(item.job.input);
    all.inputs.insert(all.inputs.end(), item.fingerprint.files.begin(), item.fingerprint.files.end());
    all.outputs.push_back(item.job.object);
    if (options.explain) all.outputs.push_back(plot_of(item.job.object));
  }
  return all;
}

/// Makes the folder that outputs go to, and finds out before hours of work whether they can be written.
Result<void> prepare_outputs(const std::vector<Item>& items, const Options& options) {
  std::vector<std::string> written;
  for (const Item& item : items) {
    if (!item.error && !item.up_to_date()) written.push_back(item.job.object);
  }
  if (!written.empty() && names_folder(options.output)) {
    std::error_code fault;
    std::filesystem::create_directories(options.output, fault);
    if (fault) return Error{ErrorClass::output, options.output, "cannot make the folder: " + fault.message()};
  }
  written.insert(written.end(), {options.stats, options.depfile});
  return check_outputs(written, {});
}

/// What kept a source from being built, but for an interruption, which is told of once, at the end.
void tell_of(const Error& error) {
  if (error.error_class != ErrorClass::interrupted) fail(kKdbuild, error);
}

void tell_of(const Item& item, bool quiet) {
  if (item.error && item.report.failed.empty()) {
    tell_of(*item.error);
    return;
  }
  for (const Error& error : item.report.failed) tell_of(error);
  for (const std::string& warning : item.report.warnings) warn(kKdbuild, item.job.input + ": " + warning);
  for (const CompileReport& object : item.report.objects) {
    const std::string mesh = object.mesh_name.empty() ? "" : fmt::format("mesh '{}': ", object.mesh_name);
    for (const std::string& warning : object.warnings)
      warn(kKdbuild, fmt::format("{}: {}{}", item.job.input, mesh, warning));
  }
  if (!quiet) print_report(item);
}

/// The status to exit with, that of the first source that failed; says how many did.
int status_of(const std::vector<Item>& items) {
  std::vector<Error> errors;
  for (const Item& item : items) {
    if (item.error) errors.push_back(*item.error);
  }
  const auto is_interrupt = [](const Error& error) { return error.error_class == ErrorClass::interrupted; };
  const auto interrupt = std::find_if(errors.begin(), errors.end(), is_interrupt);
  if (interrupt != errors.end()) {
    if (items.size() == 1) return fail(kKdbuild, *interrupt);
    return fail(kKdbuild, {ErrorClass::interrupted, "",
                           fmt::format("interrupted: {} of {} done", items.size() - errors.size(), items.size())});
  }
  if (errors.empty()) return 0;
  if (items.size() > 1) fmt::print(stderr, "{}: {} of {} failed\n", kKdbuild, errors.size(), items.size());
  return static_cast<int>(errors.front().error_class);
}

/// What would be done, and why.
int tell_plan(const std::vector<Item>& items) {
  for (const Item& item : items) {
    if (item.error) {
      tell_of(*item.error);
    } else if (item.up_to_date()) {
      print_report(item);
    } else {
      const std::string& output = item.freshness.scene.empty() ? item.job.object : item.freshness.scene;
      fmt::print("{} -> {}: to build ({})\n", item.job.input, output, item.freshness.stale);
    }
  }
  return status_of(items);
}

/// Explains each object that a source was made into, as text and as an SVG beside it.
Result<void> explain(const Item& item) {
  for (const CompileReport& object : item.report.objects) {
    if (auto explained = explain_file(object.output, true, plot_of(object.output)); !explained) return explained;
  }
  return {};
}

/// Returns what went wrong with the telling; what went wrong with an item is in it.
Result<void> build_and_tell(std::vector<Item>& items, const BatchSettings& settings, const Options& options) {
  const bool quiet = options.quiet || options.stats == "-";
  const size_t count = items.size();
  const auto name = std::filesystem::path(items.front().job.input).filename().string();
  const Progress bar =
      progress_bar(count == 1 ? "building " + name : fmt::format("building {} meshes", count), options.quiet);
  const Progress none = [](double) { return !interrupted(); };
  size_t told = 0;
  Result<void> outcome;
  build_items(items, settings, count == 1 ? bar : none, [&](const Item& item) {
    keep_going(bar, 1);  // clears the line
    tell_of(item, quiet);
    if (options.explain && outcome) outcome = explain(item);
    if (++told < count) keep_going(bar, static_cast<double>(told) / static_cast<double>(count));
  });
  return outcome;
}

Result<void> write_depfile(const std::vector<Item>& items, const std::string& path) {
  std::vector<Dependencies> rules;
  for (const Item& item : items) {
    if (!item.error) rules.push_back({item.output(), item.report.files});
  }
  return write_file(path, depfile_text(rules));
}

int run(const Options& options) {
  const ThreadLimit limit(options.threads);
  const Timer timer;
  catch_interrupts();
  if (options.explain && options.stats == "-")
    return fail(kKdbuild, {ErrorClass::usage, "--explain", "stdout has the report of --stats -: give that a file"});
  const auto jobs = plan_jobs(options.inputs, options.output);
  if (!jobs) return fail(kKdbuild, jobs.error());
  BatchSettings settings{options.settings, options.force, options.jobs, {}};
  std::vector<Item> items = look_at(*jobs, settings);
  const Neighbours known = neighbours(items, options);
  if (auto distinct = check_distinct(known.outputs, known.inputs); !distinct) return fail(kKdbuild, distinct.error());
  Claims claims(known, options.force);
  settings.claims = &claims;
  if (options.dry_run) return tell_plan(items);

  if (auto usable = prepare_outputs(items, options); !usable) return fail(kKdbuild, usable.error());
  if (auto told = build_and_tell(items, settings, options); !told) return fail(kKdbuild, told.error());
  const int status = status_of(items);
  const auto is_done = [](const Item& item) { return !item.report.objects.empty(); };
  if (status == static_cast<int>(ErrorClass::interrupted) || std::none_of(items.begin(), items.end(), is_done))
    return status;
  if (!options.depfile.empty()) {
    if (auto written = write_depfile(items, options.depfile); !written) return fail(kKdbuild, written.error());
  }
  if (!options.stats.empty()) {
    const Json report = report_json(items, options.settings, timer.seconds());
    if (auto written = write_report(options.stats, report); !written) return fail(kKdbuild, written.error());
  }
  return status;
}

/// The lattice and what is stored on it. ErrorClass::usage for options that contradict each other.
Result<void> settle_vertices(Options& o) {
  CompileSettings& s = o.settings;
  if (s.vertices == VertexForm::float32 && (s.max_error || o.bits.value_or(kMaxLatticeBits) != kMaxLatticeBits)) {
    return Error{ErrorClass::usage, "--vertices float32",
                 fmt::format("excludes {}: float32 vertices stand over a lattice of {} bits",
                             s.max_error ? "--max-error" : fmt::format("--bits {}", *o.bits), kMaxLatticeBits)};
  }
  s.bits = o.bits.value_or(s.vertices == VertexForm::float32 ? kMaxLatticeBits : kDefaultLatticeBits);
  return {};
}

/// What an object will be.
void add_object_options(CLI::App& c, const std::shared_ptr<Options>& options) {
  CompileSettings& s = options->settings;
  CLI::Option* bits = c.add_option("--bits", options->bits, "Bits of the lattice an axis")
                          ->check(whole_number(kMinLatticeBits, kMaxLatticeBits))
                          ->default_str(std::to_string(kDefaultLatticeBits));
  c.add_option("--max-error", s.max_error,
               "Use the fewest bits, from 10 on, that move no vertex further than this (model units)")
      ->check(number(1e-300, 1e300))
      ->excludes(bits);
  c.add_option_function<std::string>(
       "--vertices",
       [options](const std::string& form) {
         options->settings.vertices = form == "float32" ? VertexForm::float32 : VertexForm::lattice;
       },
       "Store vertices on the lattice, or for benchmarks (no render takes them) as float32")
      ->check(CLI::IsMember({"lattice", "float32"}))
      ->default_str("lattice");
  c.add_flag("--ambient-from-diffuse", s.ambient_from_diffuse,
             "Take a material's ambient colour from its diffuse one, whatever the MTL's Ka says");
  c.add_option_function<std::string>(
       "--split",
       [options](const std::string& by) {
         options->settings.split = by == "object" ? mesh::Split::object : mesh::Split::material;
       },
       "Make an object of each object or group of the source, or of each material, and a scene of them")
      ->check(CLI::IsMember({"object", "material"}));
  c.add_option("--max-object-size", s.max_object_size,
               "Bytes; a mesh that needs more is split into several objects, and a scene of them")
      ->check(whole_number(kSmallestObjectLimit, kLargestObject))
      ->capture_default_str();

  const char* advanced = "Advanced: the tree";
  c.add_option("--traversal-cost", s.tree.costs.traversal, "Cost of visiting a node, for the surface area heuristic")
      ->check(number(0.001, 1000))
      ->capture_default_str()
      ->group(advanced);
  c.add_option("--intersection-cost", s.tree.costs.intersection, "Cost of testing a triangle")
      ->check(number(0.001, 1000))
      ->capture_default_str()
      ->group(advanced);
  c.add_option("--empty-bonus", s.tree.costs.empty_bonus, "Share of a split's cost that cutting off empty space saves")
      ->check(number(0, 0.99))
      ->capture_default_str()
      ->group(advanced);
  c.add_option("--byte-price", s.tree.costs.byte_price,
               "What a byte a triangle is worth, in SAH cost: 0.02 for the least cost, 0.5 for small objects")
      ->check(number(0, 1000))
      ->capture_default_str()
      ->group(advanced);
  c.add_option("--max-depth", s.tree.max_depth, "Longest path in inner nodes")
      ->check(whole_number(1, kMaxDepth))
      ->capture_default_str()
      ->group(advanced);
}

/// What is done, and what is told of it.
void add_run_options(CLI::App& c, const std::shared_ptr<Options>& options) {
  c.add_flag("--force", options->force, "Build what is up to date too, and replace a scene that was written by hand");
  CLI::Option* explained = c.add_flag("--explain", options->explain,
                                      "Tell why each tree costs what it costs, and draw it beside the object, as .svg");
  CLI::Option* stats = c.add_option("--stats", options->stats, "Write a JSON report to this file, or to stdout (-)");
  CLI::Option* depfile =
      c.add_option("--depfile", options->depfile, "Write what each output was made from, for Make or Ninja")
          ->check(file_name());
  c.add_option("--jobs", options->jobs, "Meshes to compile at once; one alone uses all threads, and the least memory")
      ->check(whole_number(1, 256))
      ->capture_default_str();
  c.add_option("--threads", options->threads, "Threads to use; 0: all cores")
      ->check(whole_number(0, 4096))
      ->capture_default_str();
  CLI::Option* quiet = c.add_flag("--quiet", options->quiet, "Print nothing but errors and warnings");
  c.add_flag("--dry-run", options->dry_run, "Only tell what would be built, and why")
      ->excludes(stats)
      ->excludes(depfile)
      ->excludes(explained)
      ->excludes(quiet);
}

}  // namespace

Command build_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* c = app.add_subcommand("build", "Compile meshes to objects");
  c->add_option("inputs", options->inputs, "Meshes: " + mesh::supported_formats())->required();
  c->add_option("-o,--output", options->output,
                "The .nkd to write, or a folder for one of each input's name: one that exists, or ends in /")
      ->required()
      ->check(file_name());
  add_object_options(*c, options);
  add_run_options(*c, options);
  return {c, [options] {
            const auto settled = settle_vertices(*options);
            return settled ? run(*options) : fail(kKdbuild, settled.error());
          }};
}

}  // namespace kd::tools
