// The oracle of the stress runs, before anything is judged by it.
#include <algorithm>
#include <set>
#include <string>

#include <doctest/doctest.h>

#include "core/exact.h"
#include "stress/check.h"
#include "stress/run.h"

using namespace kd;
using namespace kd::stress;

namespace {

const ShapeRow& shape(std::string_view name) {
  const auto rows = shape_rows();
  return *std::find_if(rows.begin(), rows.end(), [&](const ShapeRow& row) { return row.name == name; });
}

StressCase case_of(std::string_view name, int bits) {
  auto c = make_case(shape(name), bits);
  REQUIRE(c);
  return std::move(*c);
}

/// Calls visit(ray, exact ray) for rays of every class but those that need traversal.
template <class Visit>
void for_each_ray(const CaseView& view, uint64_t rays, const Visit& visit) {
  for (uint32_t k = 0; k < static_cast<uint32_t>(RayClass::inside); ++k) {
    for (uint64_t i = 0; i < rays; ++i) {
      const Query q = make_query(view, static_cast<RayClass>(k), 5, i);
      LatticeRay ray;
      if (!snap_ray(q.origin, q.direction, q.t_min, q.t_max, view.object.bits, ray)) continue;
      ExactRay exact;
      REQUIRE(to_integers(ray, view.object.bits, exact));
      visit(ray, exact);
    }
  }
}

}  // namespace

TEST_CASE("stress oracle: the tests' own oracle, by polynomials in the shift, says the same") {
  for (const std::string name : {"small-ball", "slivers", "flat-cells"}) {
    for (const int bits : {10, 24}) {
      CAPTURE(name);
      CAPTURE(bits);
      const StressCase c = case_of(name, bits);
      const HostCase host(c);
      uint64_t differing = 0, met = 0, ties = 0;
      for_each_ray(host.view(), 120, [&](const LatticeRay& ray, const ExactRay& exact) {
        for (const OracleTriangle& t : c.oracle_triangles) {
          const Crossing ours = cross_triangle(exact, t);
          const test::ExactHit theirs = test::exact_hit(ray, {t.a, t.b, t.c}, bits);
          differing += ours.met != theirs.met;
          if (!ours.met || !theirs.met) continue;
          ++met;
          ties += ours.touches;
          const auto off = [](double a, long double b, double size) { return std::fabs(a - b) > 4 * 0x1p-53 * size; };
          differing += ours.touches != theirs.touches || ours.behind != (theirs.s < 0) ||
                       ours.farthest != theirs.largest || off(ours.s, theirs.s, theirs.largest) ||
                       off(ours.v, theirs.u, 1) || off(ours.w, theirs.v, 1);
        }
      });
      CHECK(differing == 0);
      CHECK(met > 150);
      CHECK(ties > 15);
    }
  }
}

TEST_CASE("stress oracle: leaving out far boxes loses no crossing ahead") {
  for (const ShapeRow& row : shape_rows()) {
    if (row.name == "fan" || row.name == "ball") continue;  // the same shapes again, larger
    CAPTURE(std::string(row.name));
    const StressCase c = case_of(row.name, 18);
    const HostCase host(c);
    uint64_t lost = 0, met = 0, visits = 0, rays = 0;
    for_each_ray(host.view(), row.name == "box" ? 30 : 300, [&](const LatticeRay&, const ExactRay& exact) {
      std::set<uint32_t> near;
      for_each_touched(c.host_view().oracle, exact, false, [&](const OracleTriangle& t) {
        if (cross_triangle(exact, t).met) near.insert(t.index);
        ++visits;
      });
      for_each_touched(c.host_view().oracle, exact, true, [&](const OracleTriangle& t) {
        const Crossing crossing = cross_triangle(exact, t);
        if (!crossing.met || crossing.behind) return;
        ++met;
        lost += near.count(t.index) == 0;
      });
      ++rays;
    });
    CHECK(lost == 0);
    CHECK(met > rays / 3);
    if (row.name != "duplicates") CHECK(visits < rays * c.triangles.size() / 2);  // and it does leave out
  }
}

TEST_CASE("stress oracle: places and boxes hold every triangle") {
  const StressCase c = case_of("box", 12);
  CHECK(c.vertices.size() == 4610);
  CHECK(c.triangles.size() == 9216);
  REQUIRE(c.places.size() == c.triangles.size());
  for (uint32_t i = 0; i < c.triangles.size(); ++i) {
    const OracleTriangle& t = c.oracle_triangles[c.places[i]];
    REQUIRE(t.index == i);
    REQUIRE(t.a == c.vertices[c.triangles[i][0]]);
    REQUIRE(t.c == c.vertices[c.triangles[i][2]]);
  }
}

TEST_CASE("stress rays: what the meshes are said to be they are") {
  for (const ShapeRow& row : shape_rows()) {
    CAPTURE(std::string(row.name));
    const StressCase c = case_of(row.name, 12);
    CHECK(c.traits.inside == row.inside);
    CHECK(c.traits.sheets == row.sheets);
    for (const auto& t : c.triangles) {
      const auto at = [&](size_t i) { return vec_cast<int64_t>(c.vertices[t[i]]); };
      REQUIRE(!(cross(at(1) - at(0), at(2) - at(0)) == Vec3<int64_t>{0, 0, 0}));
    }
  }
}

TEST_CASE(
    "stress rays: the first 2,293,776 and 774,192 from inside aim at every vertex and edge from 8 and 24 points") {
  for (const auto& [name, rays, points] :
       {std::tuple{"ball", uint64_t{2'293'776}, uint64_t{8}}, std::tuple{"box", uint64_t{774'192}, uint64_t{24}}}) {
    const StressCase c = case_of(name, 21);
    CHECK((c.vertices.size() + 3 * c.triangles.size()) * points == rays);
    const HostCase host(c);
    std::set<std::array<double, 3>> origins;
    for (uint64_t i = 0; i < rays; i += 997) {
      const Vec3d o = make_query(host.view(), RayClass::inside, 9, i).origin;
      origins.insert({o.x, o.y, o.z});
    }
    CHECK(origins.size() == points);
  }
}
