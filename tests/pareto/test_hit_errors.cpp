// What is counted as an error of a hit: a render in double, spoilt on purpose.
#include <doctest/doctest.h>

#include "pareto/hit_errors.h"
#include "pareto/meshes.h"
#include "pareto/model_space.h"

using namespace kd;
using namespace kd::bench;
using namespace kd::test;

namespace {

/// A square across the view at z = 0, twice: triangles 0 and 1, then 2 and 3 in the same place; and one further off.
std::vector<Corners> walls() {
  const Vec3d a{-1, -1, 0}, b{1, -1, 0}, c{1, 1, 0}, d{-1, 1, 0}, behind{0, 0, -1};
  const Corners lower{a, b, c}, upper{a, c, d};
  return {lower, upper, lower, upper, {a + behind, b + behind, c + behind}};
}

struct Stage {
  std::vector<Corners> triangles;
  ReferenceTracer tracer;
  std::vector<uint32_t> sources;
  View view;
  ReferenceRender reference;

  explicit Stage(std::vector<Corners> all) : triangles(all), tracer(std::move(all)) {
    for (uint32_t i = 0; i < triangles.size(); ++i) sources.push_back(i);
    const SharedCamera camera{{0.1, 0.2, 4}, {0, 0, 0}, {0, 1, 0}, 40, {1, 2, 5}};
    view = {camera, 64, 48, length(tracer.box().extent()), primary_rays(camera, 64, 48)};
    reference = render_reference(view, tracer, sources);
  }
  CornersOf corners() const {
    return [this](int64_t primitive) { return triangles[static_cast<size_t>(primitive)]; };
  }
  HitErrors errors(const std::vector<render::HitRecord>& hits, const CornersOf& form) const {
    return hit_errors(view, reference, hits, {corners(), form});
  }
  HitErrors errors(const std::vector<render::HitRecord>& hits) const { return errors(hits, corners()); }
  /// The first ray whose hit is of this primitive.
  size_t ray_at(int32_t primitive) const {
    size_t i = 0;
    while (reference.hits[i].primitive != primitive) ++i;
    return i;
  }
};

}  // namespace

TEST_SUITE("errors of hits") {
  TEST_CASE("a render in double has none but the rounding of t") {
    const Stage stage(walls());
    const HitErrors e = stage.errors(stage.reference.hits);
    CHECK(e.pixels == 64 * 48);
    CHECK(e.reference_hits > 1000);
    CHECK(e.same == e.reference_hits);
    CHECK(e.missed + e.false_hits + e.wrong + e.coincident == 0);
    CHECK(e.depth.max > 0);
    CHECK(e.relative_depth.max <= 0x1p-24);
    CHECK(e.normal.max == 0);
  }

  TEST_CASE("each kind of wrong hit is counted as what it is") {
    const Stage stage(walls());
    auto hits = stage.reference.hits;
    const size_t on_lower = stage.ray_at(0), on_upper = stage.ray_at(1), outside = stage.ray_at(-1);
    hits[on_lower].primitive = -1;
    hits[on_lower + 1].primitive = 2;  // where triangle 0 is
    hits[on_upper].primitive = 4;      // behind
    hits[outside] = {5, 0, 0.3f, 0.3f};
    REQUIRE(stage.reference.hits[on_lower + 1].primitive == 0);
    const HitErrors e = stage.errors(hits);
    CHECK(e.missed == 1);
    CHECK(e.coincident == 1);
    CHECK(e.wrong == 1);
    CHECK(e.false_hits == 1);
    CHECK(e.same == e.reference_hits - 3);
  }

  TEST_CASE("depth and normals") {
    const Stage stage(walls());
    auto hits = stage.reference.hits;
    for (render::HitRecord& hit : hits) hit.t = hit.t * 1.001f;
    const double turn = std::atan(0.01);
    const CornersOf turned = [&](int64_t primitive) {
      Corners c = stage.corners()(primitive);
      for (Vec3d& p : c) p.z = p.z + 0.01 * p.x;
      return c;
    };
    const HitErrors e = stage.errors(hits, turned);
    CHECK(e.relative_depth.median == doctest::Approx(0.001).epsilon(1e-3));
    CHECK(e.relative_depth.max == doctest::Approx(0.001).epsilon(1e-3));
    CHECK(e.depth.median > 0.0038);  // the wall is 4 away and more
    CHECK(e.depth.max < 0.0048);
    CHECK(e.normal.rms == doctest::Approx(turn * 57.29577951).epsilon(1e-6));
  }

  TEST_CASE("the spread of errors") {
    std::vector<double> sizes;
    for (int i = 1; i <= 200; ++i) sizes.push_back(i);
    const Spread s = spread(sizes);
    CHECK(s.median == 100);
    CHECK(s.p99 == 198);
    CHECK(s.max == 200);
    CHECK(s.rms == doctest::Approx(std::sqrt(201.0 * 401 / 6)));
    CHECK(spread({}).max == 0);
  }

  // On triangles of this size, this far away, a float32 test cannot do better than a fraction of a 2^-24 of the
  // distance, nor much worse.
  TEST_CASE("float32 tests in model space are off by about what float32 keeps") {
    const Stage stage(corners_of(data_mesh("icosphere.ply")));
    const ModelSpaceDepth depth = model_space_depth(stage.view, stage.reference, stage.corners());
    for (const Spread& s : {depth.moller_trumbore, depth.woop}) {
      CHECK(s.rms > 0x1p-27 * 3);
      CHECK(s.rms < 0x1p-21 * 4);
    }
  }
}

TEST_SUITE("pictures of a mesh") {
  TEST_CASE("what is lit, what is in shadow, what is not there") {
    const Stage stage(walls());
    const Picture& picture = stage.reference.picture;
    CHECK(picture.pixels.size() == 64 * 48);
    CHECK(picture.pixels[0] == Vec3f{0.25f, 0.35f, 0.5f});
    const Vec3f middle = picture.pixels[24 * 64 + 32];
    CHECK(middle.x > 0.5f);  // faces camera and light

    std::vector<uint8_t> dark(stage.reference.secondary.shadow.size(), 0);
    const Picture unlit = shade(stage.view, stage.reference.hits, stage.corners(), dark);
    CHECK(unlit.pixels[24 * 64 + 32].x < 0.2f);
    CHECK(unlit.pixels[0] == picture.pixels[0]);
  }

  TEST_CASE("a sphere is lit on the light's side") {
    const Stage stage(corners_of(data_mesh("icosphere.ply")));
    const size_t facing = stage.reference.secondary.facing;
    size_t lit = 0;
    for (const render::RayRecord& ray : stage.reference.secondary.shadow) lit += !stage.tracer.any_hit(to_ray(ray));
    // A convex body is in its own shadow exactly where it faces away, but for a point lifted off a face that the light
    // just fails to see.
    CHECK(lit >= facing);
    CHECK(lit <= facing + 3);
    CHECK(facing > 100);
  }
}
