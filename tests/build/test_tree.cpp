// The tree as a whole: the same whatever the threads, within its limits, costing what its statistics say.
#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "build/events.h"
#include "builds.h"
#include "core/tree_statistics.h"
#include "sys/parallel.h"

using namespace kd;
using namespace kd::test;

namespace {

struct Measured {
  double cost = 0;
  uint32_t inner = 0, leaves = 0, empty = 0, depth = 0, largest = 0;
};

/// The SAH cost from its definition, by recursion.
void measure(const build::Tree& tree, uint32_t index, Vec3d lo, Vec3d hi, Vec3d step, double root, uint32_t depth,
             Measured& m) {
  const Vec3d e = (hi - lo) * step;
  const double share = root > 0 ? 2 * (e.x * e.y + e.x * e.z + e.y * e.z) / root : 1;
  const Node n = tree.nodes[index];
  m.depth = std::max(m.depth, depth);
  if (is_leaf(n)) {
    ++m.leaves;
    m.empty += reference_count(n) == 0;
    m.largest = std::max(m.largest, reference_count(n));
    m.cost += 1.5 * reference_count(n) * share;
    return;
  }
  ++m.inner;
  m.cost += share;
  Vec3d middle_hi = hi, middle_lo = lo;
  middle_hi.set(split_axis(n), split_plane(n));
  middle_lo.set(split_axis(n), split_plane(n));
  measure(tree, child_of(n, 0), lo, middle_hi, step, root, depth + 1, m);
  measure(tree, child_of(n, 1), middle_lo, hi, step, root, depth + 1, m);
}

bool same(const build::Tree& a, const build::Tree& b) { return a.nodes == b.nodes && a.references == b.references; }

}  // namespace

TEST_CASE("tree: the same for 1, 2 and 8 threads and from run to run") {
  std::vector<Subject> subjects;
  subjects.push_back(subject("soup", soup_shape(21, 20000, Soup::small, 6), 21));
  for (const char* name : {"bunny.ply", "sibenik.ply"}) {
    if (auto s = shared_mesh(name, 21)) {
      subjects.push_back(std::move(*s));
    } else {
      MESSAGE("skipped: no " << name);
    }
  }
  for (const Subject& s : subjects) {
    CAPTURE(s.name);
    std::vector<build::Tree> trees;
    for (const unsigned threads : {1u, 2u, 8u}) {
      const ThreadLimit limit(threads);
      trees.push_back(tree_of(s));
    }
    if (s.name == "soup") trees.push_back(tree_of(s));  // all cores, once more
    for (size_t i = 1; i < trees.size(); ++i) CHECK(same(trees[0], trees[i]));
  }
}

TEST_CASE("tree: the statistics are the definition's") {
  for (const int bits : {6, 21}) {
    for (Subject& s : small_subjects(bits)) {
      CAPTURE(s.name);
      s.lattice.extent = {1, 20, 0.3};
      const build::Tree tree = tree_of(s);
      const TreeStatistics statistics = tree_statistics(tree.nodes, s.lattice);
      const Vec3d e = s.lattice.extent, top = vec_cast<double>(s.lattice.cube().hi);
      Measured m;
      measure(tree, 0, {0, 0, 0}, top, s.lattice.step(), 2 * (e.x * e.y + e.x * e.z + e.y * e.z), 0, m);
      CHECK(statistics.sah_cost == doctest::Approx(m.cost).epsilon(1e-12));
      CHECK(statistics.inner_nodes == m.inner);
      CHECK(statistics.leaves == m.leaves);
      CHECK(statistics.empty_leaves == m.empty);
      CHECK(statistics.depth == m.depth);
      CHECK(statistics.largest_leaf == m.largest);
      CHECK(m.leaves == m.inner + 1);
      CHECK(tree.nodes.size() == m.inner + m.leaves - m.empty + 1);
    }
  }
}

TEST_CASE("tree: splitting pays") {
  const Subject s = subject("sphere", sphere_shape(21, 4), 21);
  const TreeStatistics t = tree_statistics(tree_of(s).nodes, s.lattice);
  CHECK(t.sah_cost < 1.5 * static_cast<double>(s.shape.triangles.size()) / 20);
}

TEST_CASE("tree: at most the SAH cost of the best builder that was tried, at the same costs") {
  // Mitsuba 0.6, exact, 1 : 1.5 (docs/benchmarks.md).
  for (const auto& [name, best] : {std::pair{"sibenik.ply", 71.7}, std::pair{"bunny.ply", 63.5}}) {
    const auto s = shared_mesh(name, 21);
    if (!s) {
      MESSAGE("skipped: no " << name);
      continue;
    }
    build::BuildSettings settings;
    settings.costs.byte_price = 0.02;
    const TreeStatistics t = tree_statistics(tree_of(*s, settings).nodes, s->lattice);
    CHECK(t.sah_cost <= best);
    CHECK(t.largest_leaf < 28);
  }
}

TEST_CASE("tree: what memory costs is saved where leaves are small, and nowhere else") {
  const Subject s = subject("sphere", sphere_shape(21, 4), 21);
  size_t bytes = ~size_t{0};
  double cost = 0;
  for (const double price : {0.0, 0.02, 0.25, 2.0, 50.0}) {
    build::BuildSettings settings;
    settings.costs.byte_price = price;
    const build::Tree tree = tree_of(s, settings);
    const TreeStatistics t = tree_statistics(tree.nodes, s.lattice);
    const size_t size = tree.nodes.size() * sizeof(Node) + tree.references.size() * sizeof(uint32_t);
    CHECK(size < bytes);
    CHECK(t.sah_cost > cost);
    CHECK(t.largest_leaf <= 16);
    bytes = size;
    cost = t.sah_cost;
  }
}

TEST_CASE("tree: no deeper than asked for") {
  const Subject s = subject("soup", soup_shape(21, 500, Soup::mixed, 6), 21);
  for (const int depth : {1, 2, 7, 20, 28}) {
    const build::BuildSettings settings{{0.001, 1.5, 0.05}, depth};
    CHECK(tree_statistics(tree_of(s, settings).nodes, s.lattice).depth <=
          static_cast<uint32_t>(std::min(depth, kMaxDepth)));
  }
  const Subject few = subject("few", soup_shape(21, 20, Soup::small, 6), 21);
  CHECK(tree_statistics(tree_of(few, {{1e-6, 1.5, 0.05}, 1000}).nodes, few.lattice).depth <= kMaxDepth);
}

TEST_CASE("tree: one triangle, a flat mesh, a line of a lattice, nothing") {
  Shape one;
  one.add_triangle({0, 0, 0}, {1023, 0, 0}, {0, 1023, 1023});
  const build::Tree single = tree_of(subject("one", one, 10));
  CHECK(std::count(single.references.begin(), single.references.end(), 0u) >= 1);

  // Flat along y: the cube has no extent there.
  Shape flat;
  for (uint32_t i = 0; i < 20; ++i) {
    for (uint32_t j = 0; j < 20; ++j) flat.add_wall({50 * i, 0, 50 * j}, {50 * i + 50, 0, 50 * j + 50});
  }
  const Lattice lattice{{0, 0, 0}, {1, 0, 1}, 10};
  const auto built = build::build_tree(lattice, flat.vertices, flat.triangles, {});
  REQUIRE(built);
  const std::vector<TriangleVertices> triangles = expanded(flat);
  const ObjectView view{built->nodes.data(), built->references.data(), triangles.data(), 10};
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const Vec3d target{random.real(0, 1000), 0, random.real(0, 1000)}, d = random.vector(1);
    LatticeRay ray;
    REQUIRE(snap_ray(target - d * 3000.0, d, 0, 1e300, 10, ray));
    NoCounter counter;
    const uint32_t met = traverse<RayMode::closest>(view, ray, 1e30f, kNoTriangle, counter);
    REQUIRE(met == brute_force(triangles, ray, 1e30f, kNoTriangle));
  }
  for (uint32_t i = 0; i < flat.triangles.size(); ++i) {
    CHECK(std::count(built->references.begin(), built->references.end(), i) >= 1);
  }

  Shape tiny;  // on a lattice of 2 x 2 x 2 points
  tiny.add_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 1});
  tiny.add_triangle({0, 1, 0}, {1, 0, 1}, {1, 1, 1});
  CHECK(tree_of(subject("tiny", tiny, 1)).references.size() >= 2);

  CHECK(tree_of(subject("none", {}, 10)).references.empty());
}

TEST_CASE("tree: a wall in a face of its cell is put into a flat cell") {
  Shape wall;
  for (uint32_t i = 0; i < 10; ++i) {
    for (uint32_t j = 0; j < 20; ++j) wall.add_wall({50 * i, 0, 50 * j}, {50 * i + 50, 0, 50 * j + 50});
  }
  const auto of_wall = static_cast<uint32_t>(wall.triangles.size());
  for (uint32_t i = 0; i < 1000; ++i) {  // beside it, and as high as the cube
    const Vec3u p{600 + 40 * (i / 100), 100 * (i / 10 % 10), 100 * (i % 10)};
    wall.add_triangle(p, p + Vec3u{40, 20, 30}, p + Vec3u{10, 50, 40});
  }
  const Subject s = subject("wall", wall, 10);
  build::BuildSettings settings;
  settings.costs.byte_price = 0;
  const build::Tree tree = tree_of(s, settings);
  for_each_node(tree.nodes, s.lattice, [&](uint32_t, Node node, const Box3u& cell, uint32_t) {
    if (!is_leaf(node) || reference_count(node) < 2) return;
    if (tree.references[first_reference(node)] < of_wall) CHECK(cell.lo.y == cell.hi.y);
  });
}

TEST_CASE("tree: a bundle of needles is cut along its length, and neither it nor a hub into n x n pieces") {
  for (const uint32_t count : {60u, 400u, 1000u}) {  // of one small cell, of cells of both kinds
    CAPTURE(count);
    Shape bundle, hub;
    Random random(count);
    const auto near = [&](uint32_t x, uint32_t spread) { return x + random.integer(0, spread); };
    for (uint32_t i = 0; i < count; ++i) {
      const Vec3u a{near(0, 900), near(0, 900), near(0, 900)}, b = a + Vec3u{1000000, 1000000, 1000000};
      bundle.add_triangle(a, b, b + Vec3u{near(1, 50), near(1, 50), 0});
      const double angle = 1.5 * i / count;
      const auto rim = [](double turn) {
        return Vec3u{static_cast<uint32_t>(1e6 * std::cos(turn)), static_cast<uint32_t>(1e6 * std::sin(turn)), 5};
      };
      hub.add_triangle({0, 0, 0}, rim(angle), rim(angle + 1.5 / count));
    }
    const Subject needles = subject("bundle", bundle, 21), fan = subject("hub", hub, 21);
    const build::Tree of_needles = tree_of(needles), of_fan = tree_of(fan);
    CHECK(tree_statistics(of_needles.nodes, needles.lattice).sah_cost < 0.1 * 1.5 * count);
    CHECK(of_needles.references.size() < 300 * size_t{count});
    CHECK(of_fan.references.size() < 150 * size_t{count});
  }
}

TEST_CASE("tree: as good for the largest and the smallest models") {
  Subject s = subject("sphere", sphere_shape(21, 3), 21);
  s.lattice.extent = {1, 2, 0.5};
  const build::Tree expected = tree_of(s);
  const double cost = tree_statistics(expected.nodes, s.lattice).sah_cost;
  for (const double scale : {0x1p-900, 0x1p-500, 0x1p500, 0x1p900}) {
    s.lattice.extent = Vec3d{1, 2, 0.5} * scale;
    CHECK(same(tree_of(s), expected));
    CHECK(tree_statistics(expected.nodes, s.lattice).sah_cost == cost);
  }
}

TEST_CASE("tree: many triangles in one place") {
  Shape pile;
  for (int i = 0; i < 3000; ++i) pile.add_triangle({100, 100, 100}, {200, 100, 100}, {100, 200, 101});
  const Subject s = subject("pile", pile, 10);
  const build::Tree tree = tree_of(s);
  CHECK(tree.references.size() < 3000 * 20);
  CHECK(tree_statistics(tree.nodes, s.lattice).largest_leaf == 3000);
}

TEST_CASE("tree: cancelling, and progress that only grows") {
  const Subject s = subject("soup", soup_shape(21, 20000, Soup::small, 6), 21);
  const auto build = [&](const Progress& progress) {
    return build::build_tree(s.lattice, s.shape.vertices, s.shape.triangles, {}, progress);
  };
  std::atomic<int> calls = 0;
  const auto cancelled = build([&](double) { return ++calls < 3; });
  REQUIRE_FALSE(cancelled);
  CHECK(cancelled.error().error_class == ErrorClass::interrupted);
  CHECK(calls < 20);

  std::vector<double> shares;
  REQUIRE(build([&](double share) {
    shares.push_back(share);
    return true;
  }));
  CHECK(shares.size() > 10);
  CHECK(std::is_sorted(shares.begin(), shares.end()));
  CHECK(shares.front() >= 0);
  CHECK(shares.back() <= 1);
  CHECK(shares.back() > 0.95);
}

TEST_CASE("events: at a plane the ends come first, then the flat ones, then the starts") {
  using namespace kd::build;
  const uint32_t top = lattice_max(24);
  for (const uint32_t plane : {0u, 7u, top}) {
    const Event end = make_event(plane, EventKind::end, 0xffffffff), flat = make_event(plane, EventKind::flat, 5);
    const Event start = make_event(plane, EventKind::start, 0);
    CHECK(end < flat);
    CHECK(flat < start);
    if (plane < top) CHECK(start < make_event(plane + 1, EventKind::end, 0));
    CHECK(plane_of(end) == plane);
    CHECK(kind_of(end) == EventKind::end);
    CHECK(triangle_of(end) == 0xffffffff);
    CHECK(renumbered(flat, 9) == make_event(plane, EventKind::flat, 9));
  }
  EventList events, flat;
  append_events({{1, 5, 0}, {4, 5, 9}}, 0, 3, events);
  CHECK(events == EventList{make_event(1, EventKind::start, 3), make_event(4, EventKind::end, 3)});
  append_events({{1, 5, 0}, {4, 5, 9}}, 1, 4, flat);
  CHECK(flat == EventList{make_event(5, EventKind::flat, 4)});
}

TEST_CASE("events: the root's radix sort sorts") {
  using namespace kd::build;
  for (const int bits : {1, 10, 21, 24}) {
    Random random(static_cast<uint64_t>(bits));
    EventList events;
    for (uint32_t i = 0; i < 5000; ++i) {
      const uint32_t a = random.integer(0, lattice_max(bits)), b = random.integer(0, lattice_max(bits));
      append_events({{std::min(a, b), 0, 0}, {std::max(a, b), 0, 0}}, 0, i, events);
    }
    EventList expected = events;
    std::sort(expected.begin(), expected.end());
    sort_root_events(events, bits + 2);
    CHECK(events == expected);
  }
}
