// kdbench instances: a scene's camera rays on the CPU, through our hierarchy and trees and through Embree's instances.
#include <cmath>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "commands.h"
#include "common/console.h"
#include "embree_build.h"
#include "embree_instances.h"
#include "machine.h"
#include "measure_rays.h"
#include "render/expand.h"
#include "render/packet_intersection.h"
#include "render/strip.h"
#include "render/tiles.h"
#include "scene/parse_scene.h"
#include "sys/parallel.h"
#include "sys/timer.h"
#include "table.h"

namespace kd::bench {

namespace {

struct Options {
  std::string scene, size = "960x540";
  unsigned threads = 1;
  int repeats = 5;
};

using Hits = std::vector<std::optional<float>>;  // distances

/// Of one tracer: its hits, and the seconds of each repeat.
struct Traced {
  Hits hits;
  std::vector<double> seconds;
};

/// trace(pixels, set) for packets that make up all rays, in the renderer's order.
template <class Trace>
void trace_all(const render::Tiles& tiles, const Trace& trace, Traced& out) {
  Timer timer;
  parallel_ranges(tiles.count(), 1, [&](size_t begin, size_t end) {
    for (size_t tile = begin; tile < end; ++tile) tiles.for_each_packet(tile, trace);
  });
  out.seconds.push_back(timer.seconds());
}

/// Hits that are not the same: of one tracer alone, or farther apart than 1e-4 of their distance.
size_t differences(const Traced& a, const Traced& b) {
  size_t count = 0;
  for (size_t i = 0; i < a.hits.size(); ++i) {
    const auto &x = a.hits[i], &y = b.hits[i];
    count += x.has_value() != y.has_value() || (x && !(std::fabs(*x - *y) <= 1e-4f * std::fabs(*x)));
  }
  return count;
}

Result<void> measure(const Options& o) {
  tools::catch_interrupts();
  const ThreadLimit limit(o.threads);
  auto size = parse_size(o.size);
  if (!size) return size.error();
  auto scene = scene::read_scene(o.scene);
  if (!scene) return scene.error();
  scene->film = {size->width, size->height};
  const render::RenderSettings settings;
  auto loaded = render::load_scene(*scene, settings);
  if (!loaded) return loaded.error();
  auto peer = embree_instances(*loaded);
  if (!peer) return peer.error();

  const render::HostObjects objects(*loaded, TriangleLayout::expanded);
  const std::vector<render::InstanceView> instances = render::instance_views(*loaded);
  render::FrameView view = render::strip_view(*loaded, settings, {0, size->height});
  view.scene.hierarchy = loaded->hierarchy.data();
  view.scene.instances = instances.data();
  view.scene.objects = objects.views.data();
  std::vector<Ray> rays(size_t{size->width} * size->height);
  for (size_t i = 0; i < rays.size(); ++i) rays[i] = primary_ray(view, static_cast<uint32_t>(i));

  const render::Tiles tiles(size->width, size->height);
  Traced ours, singles, packets;
  for (Traced* traced : {&ours, &singles, &packets}) traced->hits.resize(rays.size());
  for (int i = 0; i < o.repeats; ++i) {  // in turn, as the machine's speed may drift
    if (tools::interrupted()) return Error{ErrorClass::interrupted, o.scene, "interrupted"};
    trace_all(
        tiles,
        [&](const PerRay<uint32_t>& pixels, RaySet set) {
          PerRay<Ray> packet;
          PerRay<render::SurfaceHit> found;
          for_each_ray(set, [&](size_t lane) { packet[lane] = rays[pixels[lane]]; });
          render::closest_hits<render::ThroughHierarchy<>>(view.scene, packet, set, found);
          for_each_ray(set, [&](size_t lane) {
            if (found[lane].instance != render::kNone) ours.hits[pixels[lane]] = static_cast<float>(found[lane].t);
          });
        },
        ours);
    trace_all(
        tiles,
        [&](const PerRay<uint32_t>& pixels, RaySet set) {
          for_each_ray(set, [&](size_t lane) { singles.hits[pixels[lane]] = (*peer)->closest(rays[pixels[lane]]); });
        },
        singles);
    trace_all(
        tiles,
        [&](const PerRay<uint32_t>& pixels, RaySet set) {
          PerRay<Ray> packet;
          PerRay<std::optional<float>> found;
          for_each_ray(set, [&](size_t lane) { packet[lane] = rays[pixels[lane]]; });
          (*peer)->closest(packet, set, found);
          for_each_ray(set, [&](size_t lane) { packets.hits[pixels[lane]] = found[lane]; });
        },
        packets);
  }

  const auto version = embree_version();
  if (!version) return version.error();
  fmt::print("{}: {} instances, {} camera rays ({}), {} threads, {}; medians of {}\n\n", o.scene, instances.size(),
             rays.size(), o.size, thread_count(), this_machine().processor, o.repeats);
  Table table({"tracer", "ms", "Mrays/s", "of Embree's single rays"});
  const double peer_seconds = median(singles.seconds);
  const auto add = [&](const std::string& name, const Traced& traced) {
    const double seconds = median(traced.seconds);
    table.add({name, fmt::format("{:.1f}", 1e3 * seconds),
               fmt::format("{:.2f}", 1e-6 * static_cast<double>(rays.size()) / seconds),
               fmt::format("{:.2f}", peer_seconds / seconds)});
  };
  add("exact kd-trees, packets of 8", ours);
  add(*version + ", robust, single rays", singles);
  add(*version + ", robust, packets of 8", packets);
  fmt::print("{}\n{} rays differ: one alone hits, or their distances differ by more than 1e-4.\n", table.markdown(),
             differences(ours, singles));
  return {};
}

}  // namespace

Command instances_command(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* c = app.add_subcommand("instances", "Time a scene's camera rays on the CPU, beside Embree's instances");
  c->add_option("scene", o->scene, "A scene file, as kdrender takes it")->required();
  c->add_option("--size", o->size, "Pixels of the film, WIDTHxHEIGHT")->capture_default_str();
  c->add_option("--threads", o->threads, "CPU threads; 0: all cores")
      ->check(tools::whole_number(0, 4096))
      ->capture_default_str();
  c->add_option("--repeat", o->repeats, "Runs of each tracer, in turn")
      ->check(tools::whole_number(1, 10000))
      ->capture_default_str();
  return {c, [o] {
            const auto done = measure(*o);
            return done ? 0 : tools::fail(kKdbench, done.error());
          }};
}

}  // namespace kd::bench
