// kdbench stress, from outside.
#include <iterator>
#include <sstream>

#include <doctest/doctest.h>

#include "cli/json_schema.h"
#include "cli/run_tool.h"

using namespace kd;
using namespace kd::test;

namespace {

constexpr const char* kTool = "kdbench";

uint64_t sum(const nlohmann::json& groups, const char* key) {
  uint64_t total = 0;
  for (const auto& group : groups) total += group[key].get<uint64_t>();
  return total;
}

}  // namespace

TEST_SUITE("kdbench stress") {
  TEST_CASE("every class, mesh and number of bits, summed up three ways; nothing goes wrong") {
    const Terminal t;
    const std::string text = t.succeeds(kTool, {"stress", "--rays", "9000", "--bits", "10,21,24", "--device", "cpu",
                                                "--json", "r.json", data_file("icosphere.ply")})
                                 .out;
    const auto report = nlohmann::json::parse(t.read("r.json"));
    check_report("kdbench-stress", report);
    CHECK(report["rays"] == 9000);
    CHECK(report["triangle_test"] == "exact");
    for (const char* key : {"misses", "double_counts", "mismatches"}) CHECK(report[key] == 0);
    for (const char* groups : {"classes", "bits", "meshes"}) {
      for (const char* key : {"rays", "hits", "ties", "triangle_tests"})
        CHECK(sum(report[groups], key) == report[key].get<uint64_t>());
    }
    CHECK(report["classes"].size() == 16);
    CHECK(report["bits"].size() == 3);
    CHECK(report["bits"][1]["bits"] == 21);
    CHECK(report["meshes"].size() >= 15);  // the large fan has a ray in thousands
    CHECK(report["displacement"]["below_24_bits"]["near"] <= 0.5);
    CHECK(report["failures"].empty());
    for (const char* word : {"vertices", "icosphere", "offset-ball", "0 misses, 0 double counts, 0 mismatches"})
      CHECK_MESSAGE(text.find(word) != std::string::npos, word);
    if (report.contains("embree")) CHECK(report["embree"]["default_misses"] > 0);
  }

  TEST_CASE("a selection of classes and meshes, the same on one thread") {
    const Terminal t;
    const auto run = [&](const char* threads) {
      auto report =
          t.report(kTool, {"stress", "--rays", "2000", "--class", "edges", "--class", "inside", "--mesh", "box",
                           "--bits", "16", "--seed", "7", "--threads", threads, "--device", "cpu", "--json", "-"});
      check_report("kdbench-stress", report);
      REQUIRE(report["classes"].size() == 2);
      CHECK(report["classes"][0]["class"] == "edges");
      CHECK(report["classes"][1]["class"] == "inside");
      CHECK(report["from_inside"][0]["mesh"] == "box, 16 bits");
      CHECK(report["from_inside"][0]["hits"] == 1000);
      return std::pair{report["ties"], report["triangle_tests"]};
    };
    CHECK(run("1") == run("2"));
  }

  TEST_CASE("a triangle test that leaks: exit status 1, and what failed in the report, to be traced again") {
    const Terminal t;
    for (const char* test : {"moller-trumbore", "woop"}) {
      const ToolRun run = t.run(kTool, {"stress", "--rays", "4000", "--mesh", "small-ball", "--bits", "21", "--device",
                                        "cpu", "--quiet", "--triangle-test", test, "--json", "r.json"});
      CHECK(run.status == 1);
      CHECK(run.err.empty());
      const auto report = nlohmann::json::parse(t.read("r.json"));
      check_report("kdbench-stress", report);
      CHECK(report["triangle_test"] == test);
      CHECK(report["rays"] == 4000);
      CHECK(report["double_counts"] > 100);
      for (const char* key : {"misses", "double_counts", "mismatches"})
        CHECK(sum(report["classes"], key) == report[key].get<uint64_t>());
      REQUIRE(!report["failures"].empty());
      const auto replay = report["failures"][0]["replay"].get<std::string>();
      CHECK_MESSAGE(run.out.find(replay) != std::string::npos, replay);
      CHECK(replay.find(std::string("--triangle-test ") + test) != std::string::npos);

      std::istringstream words(replay);
      Arguments again{std::istream_iterator<std::string>(words), {}};
      again.erase(again.begin());  // kdbench
      const ToolRun one = t.run(kTool, joined(again, {"--quiet"}));
      CHECK(one.status == 1);
      CHECK(one.out.find("\n1 rays, ") != std::string::npos);
      CHECK(one.out.find(replay) != std::string::npos);
    }
  }

  TEST_CASE("only what is named, and one ray of it") {
    const Terminal t;
    const auto report =
        t.report(kTool, {"stress", data_file("icosphere.ply"), "--mesh", "none", "--bits", "21", "--class", "faces",
                         "--first", "12345", "--rays", "1", "--device", "cpu", "--json", "-"});
    CHECK(report["rays"] == 1);
    CHECK(report["meshes"].size() == 1);
    CHECK(report["meshes"][0]["mesh"] == "icosphere");
  }

  TEST_CASE("errors") {
    const Terminal t;
    t.write("flat.obj", "v 0 0 0\nv 1 0 0\nf 1 1 2\n");
    const auto fails = [&](Arguments arguments, ErrorClass error_class, const std::vector<std::string>& fragments) {
      arguments.insert(arguments.begin(), {"stress", "--rays", "100"});
      t.fails(kTool, arguments, error_class, fragments);
    };
    fails({"--class", "nonsense"}, ErrorClass::usage, {"--class nonsense", "vertices", "contact"});
    fails({"--mesh", "teapot"}, ErrorClass::usage, {"--mesh teapot", "ball", "offset-ball"});
    fails({"--mesh", "none"}, ErrorClass::usage, {"no mesh"});
    fails({"--mesh", "needles", "--class", "inside"}, ErrorClass::usage, {"no mesh"});
    fails({"--triangle-test", "plucker"}, ErrorClass::usage, {"--triangle-test plucker", "exact, moller-trumbore"});
    fails({"--bits", "9"}, ErrorClass::usage, {"--bits"});
    fails({"--bits", "21,25"}, ErrorClass::usage, {"--bits"});
    fails({"--device", "nonsense"}, ErrorClass::usage, {"--device nonsense"});
    fails({"--device", "cuda:99"}, ErrorClass::device, {"--device cuda:99"});
    fails({"--mesh", "none", "gone.ply"}, ErrorClass::missing, {"gone.ply"});
    fails({"--mesh", "none", "flat.obj"}, ErrorClass::mesh, {"flat.obj"});
    fails({"--json", "gone/r.json"}, ErrorClass::output, {"gone/r.json"});
    t.fails(kTool, {"stress", "--rays", "0"}, ErrorClass::usage, {"--rays"});
    t.fails(kTool, {"stress", "--rays", "-5"}, ErrorClass::usage, {"--rays"});
  }

  TEST_CASE("--help tells of every option") {
    const Terminal t;
    const std::string help = t.succeeds(kTool, {"stress", "--help"}).out;
    for (const char* option : {"meshes", "--rays", "--device", "--class", "--mesh", "--bits", "--seed", "--first",
                               "--threads", "--triangle-test", "--json", "--quiet"}) {
      CHECK_MESSAGE(help.find(option) != std::string::npos, option);
    }
  }
}
