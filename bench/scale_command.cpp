// kdbench scale: what a scene costs as it grows: in what it lists, in what it places where nobody looks, in what the
// picture shows, in lights, and in what moves.
#include <memory>

#include <fmt/format.h>

#include "commands.h"
#include "common/console.h"
#include "machine.h"
#include "ray_options.h"
#include "scale/report.h"
#include "scale/scenes.h"
#include "scratch_folder.h"
#include "sys/parallel.h"

namespace kd::bench {

namespace {

using namespace scale;

struct Options : RayOptions {
  std::string size = "960x540", json;
  bool quick = false;
};

constexpr uint32_t kMostLights = 64;
constexpr uint32_t kInView = 100;  // instances, where their number is not what grows
constexpr uint32_t kSorts = 100;   // objects that a picture's instances are of
constexpr uint32_t kOfEach = 10;   // instances of each object, where the number of objects in view grows

/// How far each sweep goes.
struct Reach {
  uint32_t objects;
  uint64_t instances;
  uint32_t moving;
};
constexpr Reach kFull{10'000, 1'000'000, 100'000};
constexpr Reach kQuick{100, 1'000, 100};

/// first, 10 first, ... up to last.
std::vector<uint64_t> decades(uint64_t first, uint64_t last) {
  std::vector<uint64_t> counts;
  for (uint64_t n = first; n <= last; n *= 10) counts.push_back(n);
  return counts;
}

/// Measures one series after the other, and tells each as soon as it is known.
class Sweep {
 public:
  Sweep(const Options& o, render::Device device, const Quarry& quarry, std::string folder, ImageSize size)
      : device_(std::move(device)), quarry_(quarry), folder_(std::move(folder)), tells_(o.json != "-") {
    run_.device = device_.description;
    run_.film = {size.width, size.height};
    run_.effort = o.effort;
  }

  /// build(scene, count) fills an empty scene whose list has objects(count) objects.
  template <class Objects, class Build>
  Result<void> series(Series series, const std::vector<uint64_t>& counts, const Objects& objects, const Build& build) {
    for (const uint64_t count : counts) {
      if (tools::interrupted()) return Error{ErrorClass::interrupted, series.name, "interrupted"};
      auto listed = quarry_.objects(objects(count));
      if (!listed) return listed.error();
      scene::Scene scene = empty_scene(std::move(*listed), run_.film);
      build(scene, count);
      auto cost = measure_scene(scene, folder_ + "/scene.json", device_, run_.effort);
      if (!cost) return cost.error();
      cost->count = count;
      series.rows.push_back(*cost);
    }
    tell(markdown(series));
    run_.series.push_back(std::move(series));
    return {};
  }

  Result<void> motion(uint64_t instances, uint32_t most) {
    std::vector<uint64_t> counts{0};
    for (const uint64_t count : decades(10, most)) counts.push_back(count);
    auto listed = quarry_.objects(kStones);
    if (!listed) return listed.error();
    for (const uint64_t count : counts) {
      if (tools::interrupted()) return Error{ErrorClass::interrupted, "motion", "interrupted"};
      scene::Scene scene = empty_scene(*listed, run_.film);
      add_wall(scene, instances - count, Place::in_view, 0, kStones);
      add_drifting(scene, static_cast<uint32_t>(count));
      auto cost = measure_motion(scene, run_.effort);
      if (!cost) return cost.error();
      run_.motion.push_back(*cost);
    }
    tell(markdown(run_.motion));
    return {};
  }

  const ScaleRun& run() const { return run_; }

 private:
  void tell(const std::string& text) const {
    if (!tells_) return;
    fmt::print("\n{}", text);
    std::fflush(stdout);
  }

  render::Device device_;
  const Quarry& quarry_;
  std::string folder_;
  bool tells_;
  ScaleRun run_;
};

Result<void> sweep_library(Sweep& sweep, const Quarry& quarry, const Reach& reach) {
  const auto listed = [](uint64_t count) { return static_cast<uint32_t>(count); };
  const std::vector<uint64_t> counts = decades(kStones, reach.objects);
  auto done = sweep.series(
      {"library", "Objects that the scene lists; ten instances of ten of them, in view", "listed", {}}, counts, listed,
      [](scene::Scene& scene, uint64_t) { add_wall(scene, kStones, Place::in_view, 0, kStones); });
  if (!done) return done;
  done = sweep.series(
      {"folder", "Objects in the library's folder; ten instances of ten of them, in view", "in the folder", {}}, counts,
      listed, [&](scene::Scene& scene, uint64_t) {
        scene.library = quarry.folder();
        scene.objects.resize(kStones);
        add_wall(scene, kStones, Place::in_view, 0, kStones);
      });
  if (!done) return done;
  done = sweep.series({"seen_objects", "Objects with ten instances each, all in view", "in view", {}}, counts, listed,
                      [](scene::Scene& scene, uint64_t count) {
                        add_wall(scene, kOfEach * count, Place::in_view, 0, static_cast<uint32_t>(count));
                      });
  if (!done) return done;
  return sweep.series({"unseen_objects",
                       "Objects that are placed; ten of them in view, the others where nobody sees them",
                       "placed",
                       {}},
                      counts, listed, [](scene::Scene& scene, uint64_t count) {
                        add_wall(scene, kStones, Place::in_view, 0, kStones);
                        add_wall(scene, count - kStones, Place::out_of_view, kStones, static_cast<uint32_t>(count));
                      });
}

Result<void> sweep_instances(Sweep& sweep, const Reach& reach) {
  auto done = sweep.series(
      {"picture",
       "Instances of a hundred objects, all in view; they fill the picture however many they are",
       "in view",
       {}},
      decades(1, reach.instances), [](uint64_t) { return kSorts; },
      [](scene::Scene& scene, uint64_t count) { add_wall(scene, count, Place::in_view, 0, kSorts); });
  if (!done) return done;
  const auto stones = [](uint64_t) { return kStones; };
  std::vector<uint64_t> counts{0};
  for (const uint64_t count : decades(10, reach.instances)) counts.push_back(count);
  return sweep.series(
      {"unseen_instances", "A hundred instances in view, and others where nobody sees them", "out of view", {}}, counts,
      stones, [](scene::Scene& scene, uint64_t count) {
        add_wall(scene, kInView, Place::in_view, 0, kStones);
        add_wall(scene, count, Place::out_of_view, 0, kStones);
      });
}

Result<void> sweep_lights(Sweep& sweep) {
  struct Row {
    Lighting lighting;
    const char *name, *title;
  };
  constexpr Row kRows[] = {
      {Lighting::lit, "lights_lit", "Lights, all of which light what is in view, a hundred instances"},
      {Lighting::black, "lights_black", "Lights that are black"},
      {Lighting::behind, "lights_behind", "Lights behind what is in view"}};
  std::vector<uint64_t> counts{0};
  for (uint64_t n = 1; n <= kMostLights; n *= 2) counts.push_back(n);
  for (const Row& row : kRows) {
    auto done = sweep.series(
        {row.name, row.title, "lights", {}}, counts, [](uint64_t) { return kStones; },
        [&](scene::Scene& scene, uint64_t count) {
          add_wall(scene, kInView, Place::in_view, 0, kStones);
          set_lights(scene, static_cast<uint32_t>(count), row.lighting);
        });
    if (!done) return done;
  }
  return {};
}

Result<void> measure(const Options& o) {
  const ThreadLimit limit(o.threads);
  tools::catch_interrupts();
  auto size = parse_size(o.size);
  if (!size) return size.error();
  if (auto usable = tools::check_outputs({o.json}, {}); !usable) return usable;
  auto device = render::choose_device(o.device);
  if (!device) return device.error();
  auto scratch = ScratchFolder::create();
  if (!scratch) return scratch.error();
  auto quarry = Quarry::open(scratch->path());
  if (!quarry) return quarry.error();

  const Machine machine = this_machine();
  if (o.json != "-") {
    fmt::print("{}, {}, {} threads, {}; {}; medians of {}\n", device->description, machine.processor, thread_count(),
               machine.compiler, o.size, o.effort.repeats);
  }
  const Reach reach = o.quick ? kQuick : kFull;
  Sweep sweep(o, *device, *quarry, scratch->path(), *size);
  if (auto done = sweep_library(sweep, *quarry, reach); !done) return done;
  if (auto done = sweep_instances(sweep, reach); !done) return done;
  if (auto done = sweep_lights(sweep); !done) return done;
  if (auto done = sweep.motion(reach.instances, reach.moving); !done) return done;
  if (o.json.empty()) return {};
  return tools::write_report(o.json, scale_json(sweep.run()));
}

}  // namespace

Command scale_command(CLI::App& app) {
  auto o = std::make_shared<Options>();
  o->effort = {1, 5, false};
  CLI::App* c = app.add_subcommand("scale", "Measure what a scene costs as what it holds, shows and moves grows");
  c->add_option("--size", o->size, "Pixels, WxH")->capture_default_str();
  add_ray_options(*c, *o);
  c->add_flag("--quick", o->quick, "Small scenes only: up to 1000 instances and 100 objects");
  c->add_option("--json", o->json, "Write a JSON report to this file, or to stdout (-)");
  return {c, [o] {
            const auto done = measure(*o);
            return done ? 0 : tools::fail(kKdbench, done.error());
          }};
}

}  // namespace kd::bench
