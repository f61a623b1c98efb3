// A scene's rays in packets, against the same rays one by one.
#include <doctest/doctest.h>

#include <random>

#include "render/expand.h"
#include "render/packet_intersection.h"
#include "render/tiles.h"
#include "worlds.h"

using namespace kd;
using namespace kd::render;
using namespace kd::test;

namespace {

/// Cubes of all sizes, turned and mirrored, many of them in one another; some show their fronts alone.
LoadedScene crowd(const TempFolder& folder, int instances, bool one_sided, uint32_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const double spread = std::cbrt(instances);
  std::vector<scene::Part> parts;
  for (int i = 0; i < instances; ++i) {
    const double size = std::exp2(3 * unit(random) - 1);
    scene::TransformPlacement t = moved({spread * unit(random), spread * unit(random), spread * unit(random)},
                                        {size, -size, size * (1.5 + unit(random))});
    t.rotate_axis = {unit(random), unit(random), unit(random)};
    t.rotate_degrees = i % 3 == 0 ? 0 : 180 * unit(random);
    parts.push_back(part(static_cast<uint32_t>(i % 2), t));
    if (one_sided && i % 2 == 0) parts.back().sides = scene::Sides::front;
  }
  auto s = scene_of({unit_cube(21).write(folder.file("a.nkd")), unit_cube(10).write(folder.file("b.nkd"))}, parts);
  s.camera = {{0, 0, 12}, {0, 0, 0}, {0, 1, 0}, 100};
  auto loaded = load_scene(s, {});
  REQUIRE(loaded);
  return std::move(*loaded);
}

/// What the stages see of a scene, on the CPU.
struct Seen {
  HostObjects objects;
  std::vector<InstanceView> instances;
  SceneView view;

  explicit Seen(const LoadedScene& scene) : objects(scene, TriangleLayout::expanded), instances(instance_views(scene)) {
    view.instance_count = static_cast<uint32_t>(instances.size());
    view.hierarchy = scene.hierarchy.data();
    view.instances = instances.data();
    view.objects = objects.views.data();
    view.front_only = scene.front_only.empty() ? nullptr : scene.front_only.data();
  }
};

/// As a camera's, or each for itself; along axes, too.
PerRay<Ray> random_rays(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&](double size) { return Vec3d{size * unit(random), size * unit(random), size * unit(random)}; };
  const bool coherent = unit(random) > 0;
  const Vec3d from = vector(8), to = vector(4);
  PerRay<Ray> rays;
  for (Ray& ray : rays) {
    const Vec3d origin = coherent ? from : vector(8);
    Vec3d d = (coherent ? to + vector(0.3) : vector(4)) - origin;
    if (unit(random) > 0.8) d.set(static_cast<int>(random() % 3), 0);
    ray = {origin, normalised(d), unit(random) > 0.8 ? 3 : 0.0, unit(random) > 0.8 ? 6 : kFar};
  }
  return rays;
}

template <class Instances>
void compare(const LoadedScene& scene, uint32_t seed) {
  const Seen seen(scene);
  std::mt19937_64 random(seed);
  int rays_met = 0, shadowed = 0;
  for (int n = 0; n < 4000; ++n) {
    const PerRay<Ray> rays = random_rays(random);
    const RaySet set = n % 5 == 0 ? first_rays(random() % (kPacketRays + 1)) : first_rays(kPacketRays);
    PerRay<SurfaceHit> hits;
    closest_hits<Instances>(seen.view, rays, set, hits);
    PerRay<Excluded> excluded;
    for_each_ray(set, [&](size_t i) {
      const SurfaceHit alone = closest_hit<Instances>(seen.view, rays[i]);
      CHECK(hits[i].instance == alone.instance);
      CHECK(hits[i].triangle == alone.triangle);
      CHECK(hits[i].t == alone.t);
      CHECK(hits[i].u == alone.u);
      CHECK(hits[i].v == alone.v);
      rays_met += alone.instance != kNone;
      if (n % 2 == 0) excluded[i] = {alone.instance, alone.triangle};
    });
    using Shadows = typename Instances::Shadows;
    const RaySet dark = any_hits<Shadows>(seen.view, rays, excluded, set);
    for_each_ray(set, [&](size_t i) {
      CHECK(((dark & set_of(i)) != kNoRays) == any_hit<Shadows>(seen.view, rays[i], excluded[i]));
    });
    CHECK((dark & ~set) == kNoRays);
    shadowed += std::popcount(dark);
  }
  CHECK(rays_met > 500);
  CHECK(shadowed > 500);
}

}  // namespace

TEST_CASE("packets: hits in a scene are those of its rays alone") {
  const TempFolder folder;
  for (const int instances : {2, 9, 300}) {
    CAPTURE(instances);
    compare<ThroughHierarchy<>>(crowd(folder, instances, false, 1), 1);
    compare<ThroughOneSided<>>(crowd(folder, instances, true, 2), 2);
  }
}

TEST_CASE("packets: one instance alone") {
  const TempFolder folder;
  auto s = scene_of({unit_cube().write(folder.file("cube.nkd"))}, {part(0, moved({-3, -3, -3}, {6, 6, 6}))});
  const auto loaded = load_scene(s, {});
  REQUIRE(loaded);
  compare<OnlyInstance<>>(*loaded, 3);
}

TEST_CASE("packets: tiles hold every pixel once") {
  for (const auto& [width, height] : {std::pair{1u, 1u}, {3u, 5u}, {32u, 32u}, {33u, 65u}, {100u, 1u}, {131u, 70u}}) {
    const Tiles tiles(width, height);
    std::vector<int> visits(size_t{width} * height);
    for (size_t tile = 0; tile < tiles.count(); ++tile) {
      tiles.for_each_packet(tile, [&](const PerRay<uint32_t>& pixels, RaySet set) {
        for_each_ray(set, [&](size_t i) { ++visits.at(pixels[i]); });
      });
    }
    CHECK(std::count(visits.begin(), visits.end(), 1) == static_cast<ptrdiff_t>(visits.size()));
  }
}
