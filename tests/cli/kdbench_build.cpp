// kdbench build, from outside.
#include <doctest/doctest.h>

#include "cli/json_schema.h"
#include "cli/run_tool.h"

using namespace kd;
using namespace kd::test;

TEST_SUITE("kdbench build") {
  TEST_CASE("the figures of a mesh are those kdbuild gives, and its times are there") {
    const Terminal t;
    const std::string mesh = data_file("icosphere.ply");
    const auto report = t.report("kdbench", {"build", mesh, "--repeat", "2", "--threads", "2", "--json", "-"});
    check_report("kdbench-build", report);
    const auto stats = t.report("kdbuild", {"build", mesh, "-o", "s.nkd", "--stats", "-"});
    REQUIRE(report["meshes"].size() == 1);
    const auto& m = report["meshes"][0];
    CHECK(m["mesh"] == mesh);
    CHECK(m["triangles"] == 1280);
    CHECK(m["tree"] == stats["tree"]);
    CHECK(m["bytes"]["total"] == stats["bytes"]["total"]);
    CHECK(m["bytes"]["triangles"] == 4 * 1280 + kTripleMargin);
    CHECK(m["bytes"]["vertices"] == 8 * 642 + kTripleMargin);
    uint64_t sections = 0;
    for (const char* part : {"nodes", "references", "triangles", "vertices", "rest"}) {
      sections += m["bytes"][part].get<uint64_t>();
    }
    CHECK(m["bytes"]["total"] == sections);
    CHECK(m["memory"]["peak"] > m["memory"]["before"]);
    for (const auto& [name, seconds] : m["seconds"].items()) {
      CHECK_MESSAGE(seconds["min"] > 0, name);
      CHECK(seconds["min"] <= seconds["median"]);
      CHECK(seconds["median"] <= seconds["max"]);
    }
    const bool with_embree = report["embree"].get<std::string>().starts_with("Embree 3.");
    CHECK(m["seconds"].contains("embree_medium") == with_embree);
    CHECK(m["seconds"].contains("embree_high") == with_embree);
  }

  TEST_CASE("memory grows with the mesh") {
    const Terminal t;
    const auto report = t.report(
        "kdbench", {"build", data_file("cube.obj"), data_file("icosphere.ply"), "--repeat", "1", "--json", "-"});
    const auto added = [&](size_t i) {
      const auto& memory = report["meshes"][i]["memory"];
      return memory["peak"].get<int64_t>() - memory["before"].get<int64_t>();
    };
    CHECK(added(1) > added(0) + 20 * 1280);  // the object alone has more
  }

  TEST_CASE("three tables, a row a mesh, and the settings that were used") {
    const Terminal t;
    const std::string out =
        t.succeeds("kdbench", {"build", data_file("cube.obj"), data_file("icosphere.ply"), "--repeat", "1",
                               "--max-depth", "5", "--traversal-cost", "3", "--json", "r.json"})
            .out;
    for (const char* row : {"|      cube |", "| icosphere |"}) {
      size_t found = 0;
      for (size_t at = out.find(row); at != std::string::npos; at = out.find(row, at + 1)) ++found;
      CHECK(found == 3);
    }
    CHECK(out.find("costs 3 : 1.5, empty bonus 0.08, byte price 0.35, depth 5") != std::string::npos);
    const auto report = nlohmann::json::parse(t.read("r.json"));
    check_report("kdbench-build", report);
    CHECK(report["settings"]["traversal_cost"] == 3);
    CHECK(report["meshes"][1]["tree"]["depth"] == 5);
  }

  TEST_CASE("errors") {
    const Terminal t;
    const std::string mesh = data_file("cube.obj");
    const auto fails = [&](Arguments arguments, ErrorClass error_class, const std::vector<std::string>& fragments) {
      arguments.insert(arguments.begin(), "build");
      t.fails("kdbench", arguments, error_class, fragments);
    };
    t.write("bad.ply", "ply\nformat ascii 1.0\nnonsense\n");
    t.write("flat.obj", "v 0 0 0\nv 1 0 0\nf 1 2 2\n");
    fails({}, ErrorClass::usage, {"meshes"});
    fails({"gone.ply"}, ErrorClass::missing, {"gone.ply"});
    fails({mesh, "bad.ply"}, ErrorClass::mesh, {"bad.ply"});
    fails({"flat.obj"}, ErrorClass::mesh, {"flat.obj", "nothing is left"});
    fails({mesh, "--json", "gone/r.json"}, ErrorClass::output, {"gone/r.json"});
    fails({mesh, "--json", mesh}, ErrorClass::usage, {"cube.obj"});
    fails({mesh, "--repeat", "0"}, ErrorClass::usage, {"--repeat"});
    fails({mesh, "--threads", "0"}, ErrorClass::usage, {"--threads"});
    fails({mesh, "--traversal-cost", "0"}, ErrorClass::usage, {"--traversal-cost"});
    fails({mesh, "--empty-bonus", "1"}, ErrorClass::usage, {"--empty-bonus"});
    fails({mesh, "--max-depth", "65"}, ErrorClass::usage, {"--max-depth"});
  }
}
