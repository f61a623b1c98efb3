// kdbench floor, from outside.
#include <doctest/doctest.h>

#include "cli/json_schema.h"
#include "cli/run_tool.h"

using namespace kd;
using namespace kd::test;

namespace {

const std::string kCamera = "0 0 3  0 0 0  0 1 0\n45  2 2 2\n";

Arguments on_cpu(const Arguments& more) {
  Arguments arguments{"floor",     "compiled/icosphere.nkd",
                      "--cameras", ".",
                      "--size",    "64x48",
                      "--repeat",  "1",
                      "--warm-up", "0",
                      "--device",  "cpu"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

}  // namespace

TEST_SUITE("kdbench floor") {
  TEST_CASE("the work of the shared rays is what kdbench trace counts") {
    Terminal t;
    t.compile_data("icosphere.ply");
    t.write("icosphere.txt", kCamera);
    const auto report = t.report("kdbench", on_cpu({"--json", "-"}));
    check_report("kdbench-floor", report);
    CHECK(!report.contains("chip"));
    const auto& classes = report["objects"][0]["classes"];
    REQUIRE(classes.size() == 3);

    const auto trace = t.report("kdbench", {"trace", "compiled/icosphere.nkd", "--camera", "icosphere.txt", "--size",
                                            "64x48", "--repeat", "1", "--count", "--device", "cpu", "--json", "-"});
    for (size_t i = 0; i < 3; ++i) {
      CHECK(classes[i]["class"] == trace["results"][i]["class"]);
      CHECK(classes[i]["rays"] == trace["results"][i]["rays"]);
      CHECK(classes[i]["hits"] == trace["results"][i]["hits"]);
      const auto& a_ray = classes[i]["per_ray"];
      for (const char* count : {"nodes", "leaves", "triangles"})
        CHECK(a_ray[count] == trace["results"][i]["steps_per_ray"][count]);
      CHECK(a_ray["bytes_streamed"] == 48);
      const double lanes = classes[i]["lanes"];
      CHECK(lanes > 1);
      CHECK(lanes <= 32);
    }
    // A warp's primary rays stay closer together than bounces.
    CHECK(classes[0]["lanes"] > classes[2]["lanes"]);
  }

  TEST_CASE("rays that all do the same keep every lane busy") {
    Terminal t;
    t.compile_data("quad.obj");
    t.write("quad.txt", "0 3 0  0 0 0  0 0 1  1  0 3 0\n");  // sees nothing but the quad
    const auto report =
        t.report("kdbench", {"floor", "compiled/quad.nkd", "--cameras", ".", "--size", "8x8", "--repeat", "1",
                             "--warm-up", "0", "--device", "cpu", "--threads", "1", "--json", "-"});
    const auto& primary = report["objects"][0]["classes"][0];
    CHECK(primary["hits"] == 64);
    CHECK(primary["lanes"].get<double>() > 16);
    // At the least the way in, a leaf with a triangle that is hit, and the way out.
    CHECK(primary["per_ray"]["instructions"].get<double>() >= 249 + 25 + 55 + 58 + 100);
  }

  TEST_CASE("a table, and why there is no floor on a CPU") {
    Terminal t;
    t.compile_data("icosphere.ply");
    t.write("icosphere.txt", kCamera);
    const std::string out = t.succeeds("kdbench", on_cpu({})).out;
    for (const char* text :
         {"icosphere", "primary", "shadow", "diffuse", "instructions", "lanes", "Mrays/s", "No floor for a CPU"}) {
      CHECK_MESSAGE(out.find(text) != std::string::npos, text);
    }
  }

  TEST_CASE("errors") {
    Terminal t;
    t.compile_data("icosphere.ply");
    t.fails("kdbench", {"floor"}, ErrorClass::usage, {"objects"});
    t.fails("kdbench", {"floor", "compiled/icosphere.nkd"}, ErrorClass::usage, {"--cameras"});
    t.fails("kdbench", on_cpu({}), ErrorClass::missing, {"icosphere.txt"});
    t.fails("kdbench", on_cpu({"--size", "0x5"}), ErrorClass::usage, {"--size"});
    t.fails("kdbench", on_cpu({"--json", "gone/r.json"}), ErrorClass::output, {"gone/r.json"});
    t.fails("kdbench", {"floor", "gone.nkd", "--cameras", ".", "--device", "cpu"}, ErrorClass::missing, {"gone.nkd"});
    t.succeeds("kdbuild", {"build", data_file("icosphere.ply"), "-o", "f.nkd", "--vertices", "float32"});
    t.fails("kdbench", {"floor", "f.nkd", "--cameras", ".", "--device", "cpu"}, ErrorClass::object,
            {"f.nkd", "float32"});
  }
}
