// kdbench surface, from outside.
#include <doctest/doctest.h>

#include "cli/run_tool.h"
#include "sys/hash.h"

using namespace kd;
using namespace kd::test;

namespace {

/// What kdbuild finds in a surface of so many triangles.
nlohmann::json stats(const Terminal& t, uint64_t triangles) {
  t.succeeds("kdbench", {"surface", "--triangles", std::to_string(triangles), "-o", "s.ply"});
  return t.report("kdbuild", {"build", "s.ply", "-o", "s.nkd", "--stats", "-", "--force"});
}

}  // namespace

TEST_SUITE("kdbench surface") {
  TEST_CASE("any number of triangles, in one piece, and nothing to clean") {
    const Terminal t;
    for (uint64_t triangles : {2, 3, 4, 5, 7, 8, 9, 31, 32, 33, 1000, 4001}) {
      CAPTURE(triangles);
      const auto report = stats(t, triangles);
      const auto& mesh = report["mesh"];
      CHECK(mesh["source_triangles"] == triangles);
      CHECK(mesh["triangles"] == triangles);
      for (const char* fault : {"non_finite", "degenerate", "duplicate", "opposite", "collapsed"}) {
        CHECK_MESSAGE(mesh[fault]["count"] == 0, fault);
      }
      CHECK(mesh["welded_vertices"] == 0);
      CHECK(mesh["components"] == 1);
      CHECK(mesh["non_manifold_edges"] == 0);
      CHECK(mesh["inconsistent_edges"] == 0);
      // Euler: a disc has V - E + F = 1, and every edge but those of the border lies between two triangles.
      const uint64_t vertices = mesh["vertices"], border = mesh["boundary_edges"];
      CHECK(2 * (vertices + triangles - 1) == 3 * triangles + border);
    }
  }

  TEST_CASE("it says what it wrote, and every vertex is used") {
    const Terminal t;
    const std::string out = t.succeeds("kdbench", {"surface", "--triangles", "800", "-o", "s.ply"}).out;
    CHECK(out == "s.ply: 800 triangles, 441 vertices\n");
    const std::string ply = t.read("s.ply");
    CHECK(ply.size() == ply.find("end_header\n") + 11 + 441 * 12 + 800 * 13);
    CHECK(stats(t, 800)["mesh"]["vertices"] == 441);
    CHECK(stats(t, 800)["mesh"]["boundary_edges"] == 80);
  }

  TEST_CASE("the same bytes on every machine") {
    const Terminal t;
    t.succeeds("kdbench", {"surface", "--triangles", "20001", "-o", "a.ply"});
    const std::string bytes = t.read("a.ply");
    CHECK(hash_text(hash_span(std::span(bytes))) == "069cf0b69a769919");
  }

  TEST_CASE("errors") {
    const Terminal t;
    const auto fails = [&](Arguments arguments, ErrorClass error_class, const std::vector<std::string>& fragments,
                           const Conditions& conditions = {}) {
      arguments.insert(arguments.begin(), "surface");
      t.fails("kdbench", arguments, error_class, fragments, conditions);
    };
    fails({"-o", "s.ply"}, ErrorClass::usage, {"--triangles"});
    fails({"--triangles", "100"}, ErrorClass::usage, {"--output"});
    for (const char* count : {"0", "1", "1000000001", "-5", "1e6", "many"}) {
      fails({"--triangles", count, "-o", "s.ply"}, ErrorClass::usage, {"--triangles", count});
    }
    fails({"--triangles", "100", "-o", "gone/s.ply"}, ErrorClass::output, {"gone/s.ply"});
    Conditions full_disk;
    full_disk.largest_file = 100'000;
    fails({"--triangles", "20000", "-o", "s.ply"}, ErrorClass::output, {"s.ply"}, full_disk);
    Conditions interrupted;
    interrupted.signal = 2;
    interrupted.signal_after = std::chrono::milliseconds(100);
    fails({"--triangles", "300000000", "-o", "s.ply"}, ErrorClass::interrupted, {"s.ply"}, interrupted);
  }
}
