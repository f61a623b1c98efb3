// The scene level: the tree over instances finds what a loop over all of them finds.
#include <doctest/doctest.h>

#include <algorithm>

#include "render/stages/object_intersection.h"
#include "worlds.h"

using namespace kd;
using namespace kd::test;

namespace {

/// Two objects, placed `count` times, as the stages see them.
struct World {
  TempFolder folder;
  Traced soup{soup_shape(12, 40, Soup::mixed, 1), 12};
  Traced box{box_shape({0, 0, 0}, {1023, 1023, 1023}), 10};
  std::vector<render::ShadedObjectView> objects{{soup.view(), {1, 1, 1}}, {box.view(), {1, 1, 1}}};
  std::vector<scene::Instance> instances;
  std::vector<render::InstanceView> views;
  std::vector<HierarchyNode> hierarchy;

  World(std::vector<scene::Part> parts, double offset = 0) {
    for (scene::Part& p : parts) std::get<scene::BoxPlacement>(p.placement).box.point.x += offset;
    scene::Scene s = scene_of({"soup", "box"}, std::move(parts));
    instances = *scene::place_instances(s, std::array{soup.lattice, box.lattice});
    hierarchy = scene::build_hierarchy(instances);
    for (const scene::Instance& i : instances) views.push_back({i.scene_to_lattice, i.lattice_to_scene, i.object});
  }
  render::SceneView view() const {
    render::SceneView v;
    v.hierarchy = hierarchy.data();
    v.instances = views.data();
    v.objects = objects.data();
    v.instance_count = static_cast<uint32_t>(views.size());
    return v;
  }
  /// Every instance, whole, one after the other.
  render::SurfaceHit loop(const Ray& ray) const {
    render::SurfaceHit best;
    for (uint32_t i = 0; i < views.size(); ++i) {
      const Traced& object = instances[i].object == 0 ? soup : box;
      LatticeRay lattice_ray;
      if (!snap_ray(views[i].to_lattice.apply_point(ray.origin), views[i].to_lattice.apply_vector(ray.direction),
                    ray.t_min, ray.t_max, object.lattice.bits, lattice_ray)) {
        continue;
      }
      const uint32_t triangle = brute_force(object.triangles, lattice_ray, 1e30f, kNoTriangle);
      if (triangle == kNoTriangle) continue;
      TriangleHit hit{};
      intersect_triangle(lattice_ray, object.triangles[triangle], hit);
      render::reduce(best, {lattice_ray.t_at(hit.s), hit.u, hit.v, i, triangle});
    }
    return best;
  }
};

std::vector<scene::Part> random_parts(int count, uint64_t seed, double size) {
  Random random(seed);
  std::vector<scene::Part> parts;
  while (static_cast<int>(parts.size()) < count) {
    const Frame f{random.vector(10), random.vector(size), random.vector(size), random.vector(size)};
    if (std::fabs(relative_volume(f)) < 1e-3) continue;
    parts.push_back(part(random.integer(0, 1), scene::BoxPlacement{f}));
  }
  return parts;
}

/// How many rays find another instance or triangle through the tree, or another answer to whether there is any.
int differences(const World& world, int rays, double offset, int& hits) {
  Random random(8);
  const render::SceneView view = world.view();
  int wrong = 0;
  for (int i = 0; i < rays; ++i) {
    Ray ray{random.vector(14) + Vec3d{offset, 0, 0}, random.vector(1), 0, 1e300};
    const auto some = [&]() -> const scene::Instance& {
      return world.instances[random.integer(0, static_cast<uint32_t>(world.instances.size() - 1))];
    };
    if (random.chance(0.7)) {
      const Shape& shape = world.soup.shape;
      const Vec3u v = shape.vertices[random.integer(0, static_cast<uint32_t>(shape.vertices.size() - 1))];
      ray.direction = some().lattice_to_scene.apply_point(vec_cast<double>(v)) - ray.origin;
    }
    if (random.chance(0.2)) ray.direction.set(static_cast<int>(random.integer(0, 2)), 0);
    if (random.chance(0.2)) ray.t_max = random.real(0, 30);
    if (random.chance(0.1)) {  // along an axis, and through an instance's corner
      ray.direction = {0, 0, 0};
      ray.direction.set(static_cast<int>(random.integer(0, 2)), 1);
      ray.origin = some().box_scene.lo - ray.direction * 5.0;
    }
    const render::SurfaceHit expected = world.loop(ray), found = render::closest_hit(view, ray);
    wrong += found.instance != expected.instance || found.triangle != expected.triangle || found.t != expected.t;
    wrong += render::any_hit(view, ray, {}) != (expected.instance != render::kNone);
    hits += expected.instance != render::kNone;
  }
  return wrong;
}

}  // namespace

TEST_CASE("instances: the nearest hit of 200 random ones") {
  for (const double size : {0.5, 3.0}) {
    const World world(random_parts(200, 3, size));
    int hits = 0;
    CHECK(differences(world, 5000, 0, hits) == 0);
    CHECK(hits > 800);
  }
}

TEST_CASE("instances: the only one, with a hierarchy and without") {
  Random random(12);
  int hits = 0, wrong = 0;
  for (int i = 0; i < 20; ++i) {
    const World world(random_parts(1, 30 + static_cast<uint64_t>(i), 3));
    const render::SceneView view = world.view();
    for (int k = 0; k < 500; ++k) {
      const Vec3d origin = random.vector(14), target = random.vector(10);
      const Ray ray{origin, target - origin, 0, random.chance(0.2) ? random.real(0, 2) : 1e300};
      const render::SurfaceHit expected = render::closest_hit<render::ThroughHierarchy<>>(view, ray);
      const render::SurfaceHit found = render::closest_hit<render::OnlyInstance<>>(view, ray);
      wrong += found.instance != expected.instance || found.triangle != expected.triangle || found.t != expected.t;
      wrong += render::any_hit<render::OnlyInstance<>>(view, ray, {}) != (expected.instance != render::kNone);
      hits += expected.instance != render::kNone;
    }
  }
  CHECK(wrong == 0);
  CHECK(hits > 100);
}

TEST_CASE("instances: the same a million sizes away") {
  const World world(random_parts(60, 4, 2), 1e6);
  int hits = 0;
  CHECK(differences(world, 3000, 1e6, hits) == 0);
  CHECK(hits > 300);
}

TEST_CASE("instances: coincident ones, of which the first named wins") {
  std::vector<scene::Part> parts;
  for (int i = 0; i < 9; ++i) {
    parts.push_back(part(1, scene::BoxPlacement{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}));
  }
  const World world(parts);
  const render::SurfaceHit hit = render::closest_hit(world.view(), {{0.3, 0.4, 5}, {0, 0, -1}, 0, 1e300});
  CHECK(hit.instance == 0);
  CHECK(hit.t == doctest::Approx(4));
  int hits = 0;
  CHECK(differences(world, 2000, 0, hits) == 0);
}

TEST_CASE("instances: a frame takes model space, sheared and mirrored") {
  const Lattice lattice{{-1, 2, 5}, {4, 8, 2}, 10};
  const Frame frame{{10, 20, 30}, {-2, 0, 0}, {1, 3, 0}, {0, 0.5, 1}};
  const auto instances =
      scene::place_instances(scene_of({"object"}, {part(0, scene::FramePlacement{frame})}), std::array{lattice});
  REQUIRE(instances);
  const scene::Instance& instance = instances->at(0);
  for (const Vec3u q : {Vec3u{0, 0, 0}, Vec3u{1023, 0, 0}, Vec3u{17, 1023, 400}}) {
    const Vec3d expected = frame.apply_point(lattice.to_model(q));
    CHECK(length(instance.lattice_to_scene.apply_point(vec_cast<double>(q)) - expected) < 1e-12);
    CHECK(length(instance.scene_to_lattice.apply_point(expected) - vec_cast<double>(q)) < 1e-9);
  }
}

TEST_CASE("instances: one, and none") {
  const World one(random_parts(1, 5, 3));
  CHECK(one.hierarchy.size() == 1);
  int hits = 0;
  CHECK(differences(one, 2000, 0, hits) == 0);
  const World none({});
  CHECK(none.hierarchy.empty());
  CHECK(render::closest_hit(none.view(), {{0, 0, 0}, {0, 0, 1}, 0, 1e300}).instance == render::kNone);
  CHECK_FALSE(render::any_hit(none.view(), {{0, 0, 0}, {0, 0, 1}, 0, 1e300}, {}));
}

TEST_CASE("instances: the tree holds each once, children follow parents, boxes hold boxes") {
  const World world(random_parts(200, 6, 1));
  std::vector<int> seen(200, 0);
  for (size_t i = 0; i < world.hierarchy.size(); ++i) {
    const HierarchyNode& n = world.hierarchy[i];
    if (n.is_leaf) {
      ++seen[n.first];
      continue;
    }
    REQUIRE(n.first > i);
    REQUIRE(n.first + 1 < world.hierarchy.size());
    for (size_t child : {size_t{n.first}, size_t{n.first} + 1}) {
      const HierarchyNode& c = world.hierarchy[child];
      for (int axis = 0; axis < 3; ++axis) CHECK((n.lo[axis] <= c.lo[axis] && n.hi[axis] >= c.hi[axis]));
    }
  }
  CHECK(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
}

TEST_CASE("instances: a shadow ray's own triangle is left out, the same one of another instance is not") {
  const World world({part(1, scene::BoxPlacement{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}),
                     part(1, scene::BoxPlacement{{{0, 0, 3}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}})});
  const Ray up{{0.3, 0.4, 0.5}, {0, 0, 1}, 0, 1};
  const render::SurfaceHit own = render::closest_hit(world.view(), up);
  REQUIRE(own.instance == 0);
  CHECK_FALSE(render::any_hit(world.view(), up, {0, own.triangle}));
  CHECK(render::any_hit(world.view(), up, {1, own.triangle}));
  CHECK(render::any_hit(world.view(), {up.origin, up.direction, 0, 1e300}, {0, own.triangle}));
}
