// The contract itself: no miss, no double count, no mismatch in ten million rays.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "stress/plan.h"
#include "support/workshop.h"
#include "sys/parallel.h"
#include "sys/timer.h"

using namespace kd;
using namespace kd::stress;
using namespace kd::test;

namespace {

std::vector<StressRow> run(const StressSettings& settings, const char* device_name = "cpu") {
  const auto device = render::choose_device(device_name);
  REQUIRE(device);
  auto rows = run_stress(settings, *device, {});
  REQUIRE_MESSAGE(rows, (rows ? "" : rows.error().line()));
  return std::move(*rows);
}

/// No faults, and snapping within its bounds. Returns the sum.
Tally check_rows(const std::vector<StressRow>& rows) {
  Tally total;
  for (const StressRow& row : rows) {
    const std::string name =
        fmt::format("{}, {} bits, {}", row.mesh, row.bits, class_rows()[static_cast<size_t>(row.ray_class)].name);
    for (const Failure& f : row.failures)
      MESSAGE(name << ": ray " << f.index << ", fault " << static_cast<int>(f.fault));
    CHECK_MESSAGE(row.tally[kMisses] == 0, name);
    CHECK_MESSAGE(row.tally[kDoubleCounts] == 0, name);
    CHECK_MESSAGE(row.tally[kMismatches] == 0, name);
    CHECK_MESSAGE(row.tally.moved_near <= allowed_near(row.bits), name);
    CHECK_MESSAGE(row.tally.moved_far <= allowed_far(row.bits), name);
    if (row.ray_class == RayClass::inside) CHECK_MESSAGE(row.tally[kHits] == row.tally[kRays], name);
    total.add(row.tally);
  }
  return total;
}

void tell(const char* what, const Tally& t, double seconds) {
  MESSAGE(
      fmt::format("{}: {} rays, {} misses, {} double counts, {} mismatches; {:.1f} % of {} triangle tests in double "
                  "precision; Embree robust misses {}, default {}, of {}; {:.1f} s",
                  what, t[kRays], t[kMisses], t[kDoubleCounts], t[kMismatches],
                  100.0 * static_cast<double>(t[kDoubleTests]) / static_cast<double>(t[kTriangleTests]),
                  t[kTriangleTests], t[kRobustMisses], t[kDefaultMisses], t[kPeerRays], seconds));
}

}  // namespace

TEST_CASE("stress: ten million adversarial rays, every class, every number of bits, against exact integers") {
  StressSettings settings;
  settings.rays = KD_STRESS_RAYS;
  Timer timer;
  const auto rows = run(settings);
  const Tally total = check_rows(rows);
  tell("made here", total, timer.seconds());
  CHECK(total[kRays] == settings.rays);
  CHECK(total[kHits] > settings.rays / 2);
  CHECK(total[kTies] > settings.rays / 10);  // that the rays are worth something
  CHECK(total[kPlain] > settings.rays / 200);
  CHECK(total.moved_near > 0.49);
}

TEST_CASE("stress: the real meshes, the bad ones at every number of bits") {
  StressSettings good, bad;
  for (const char* name : kRealMeshes) {
    const auto mesh = shared_mesh(std::string(name) + ".ply");
    if (!mesh) {
      MESSAGE("skipped: no " << name << " in " << shared_data().string());
      continue;
    }
    (std::string_view(name).starts_with("bad_") ? bad : good).files.push_back(mesh->string());
  }
  good.meshes = bad.meshes = {"none"};
  good.bits = {kDefaultLatticeBits};
  good.rays = KD_STRESS_RAYS / 40;
  bad.rays = KD_STRESS_RAYS / 20;
  for (const auto& [name, settings] : {std::pair{"real meshes", &good}, std::pair{"bad meshes", &bad}}) {
    if (settings->files.empty()) continue;
    Timer timer;
    const Tally total = check_rows(run(*settings));
    tell(name, total, timer.seconds());
    CHECK(total[kHits] > settings->rays / 5);
  }
}

TEST_CASE("stress: the same rays and the same counts for any number of threads, and on a GPU") {
  StressSettings settings;
  settings.rays = 60'000;
  settings.bits = {10, 21};
  SUBCASE("exact") {}
  SUBCASE("Woop") { settings.test = render::TriangleTest::woop; }
  SUBCASE("Möller-Trumbore") { settings.test = render::TriangleTest::moller_trumbore; }
  const auto two = run(settings);
  const auto same = [&](const std::vector<StressRow>& other) {
    REQUIRE(other.size() == two.size());
    for (size_t i = 0; i < two.size(); ++i) {
      for (uint32_t c = 0; c < kPeerRays; ++c) CHECK(other[i].tally.counts[c] == two[i].tally.counts[c]);
      CHECK(other[i].tally.moved_near == two[i].tally.moved_near);
      CHECK(other[i].tally.moved_far == two[i].tally.moved_far);
    }
  };
  {
    const ThreadLimit one(1);
    same(run(settings));
  }
  if (const auto cuda = render::choose_device("cuda"); !cuda) {
    MESSAGE("skipped: " << cuda.error().line());
  } else {
    same(run(settings, "cuda"));
  }
}

TEST_CASE("stress: a ray can be traced again by its number") {
  StressSettings settings;
  settings.meshes = {"small-ball"};
  settings.classes = {"edges"};
  settings.bits = {16};
  settings.rays = 1000;
  Tally sum;
  for (uint64_t first = 0; first < 1000; first += 250) {
    StressSettings part = settings;
    part.first = first;
    part.rays = 250;
    for (const StressRow& row : run(part)) sum.add(row.tally);
  }
  const auto whole = run(settings);
  REQUIRE(whole.size() == 1);
  for (const Count c : {kRays, kSnapped, kHits, kTies, kTriangleTests, kDoubleTests})
    CHECK(sum[c] == whole[0].tally[c]);
}
