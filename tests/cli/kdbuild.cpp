// kdbuild build, from outside. (info and validate: kdbuild_objects.cpp.)
#include <csignal>
#include <filesystem>
#include <set>

#include <doctest/doctest.h>
#include <sys/stat.h>

#include "cli/json_schema.h"
#include "cli/meshes.h"
#include "cli/run_tool.h"

using namespace kd;
using namespace kd::test;

namespace {

constexpr const char* kTool = "kdbuild";

const std::string kTetrahedronOff = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
const std::string kTetrahedronPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

std::string tetrahedron_stl() {
  const char* corner[] = {"0 0 0", "1 0 0", "0 1 0", "0 0 1"};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  std::string text = "solid tetrahedron\n";
  for (const auto& face : faces) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int c : face) text += std::string("vertex ") + corner[c] + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid\n";
}

}  // namespace

TEST_SUITE("kdbuild build") {
  TEST_CASE("reads every format") {
    const Terminal t;
    t.write("a.obj", kTetrahedronObj);
    t.write("b.off", kTetrahedronOff);
    t.write("c.ply", kTetrahedronPly);
    t.write("d.stl", tetrahedron_stl());
    t.write("E.OBJ", kTetrahedronObj);
    for (const char* mesh : {"a.obj", "b.off", "c.ply", "d.stl", "E.OBJ"}) {
      const auto report = t.report(kTool, {"build", mesh, "-o", "x.nkd", "--stats", "-"});
      check_report("kdbuild-stats", report);
      CHECK(report["mesh"]["triangles"] == 4);
      CHECK(report["mesh"]["vertices"] == 4);
      CHECK(report["mesh"]["closed"] == true);
      CHECK(report["bytes"]["total"] == t.read("x.nkd").size());
      t.succeeds(kTool, {"validate", "x.nkd"});
    }
    const ToolRun text = t.succeeds(kTool, {"build", data_file("icosphere.ply"), "-o", "i.nkd"});
    CHECK(text.out.find("1280 triangles, 642 vertices in one piece") != std::string::npos);
  }

  TEST_CASE("a flat mesh is legal") {
    const Terminal t;
    const auto report = t.report(kTool, {"build", data_file("quad.obj"), "-o", "q.nkd", "--stats", "-"});
    CHECK(report["mesh"]["triangles"] == 2);
    CHECK(report["lattice"]["extent"] == nlohmann::json{1.0, 0.0, 1.0});
    t.succeeds(kTool, {"validate", "q.nkd"});
  }

  TEST_CASE("counts and names what it drops") {
    const Terminal t;
    t.write("faults.obj",
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 1\nv 0 inf 1\n"
            "f 1 2 3\nf 1 2 4\nf 1 2 5\nf 1 2 2\nf 3 1 2\nf 2 1 3\n");
    const ToolRun text = t.succeeds(kTool, {"build", "faults.obj", "-o", "x.nkd", "--stats", "s.json"});
    for (const char* line : {"2 with a coordinate that is not finite: dropped, the first is triangle 1",
                             "1 without area: dropped, the first is triangle 3",
                             "1 the same as an earlier one: dropped, the first is triangle 4",
                             "1 the back of an earlier one: kept, the first is triangle 5"}) {
      CHECK_MESSAGE(text.out.find(line) != std::string::npos, line << "\n" << text.out);
    }
    const auto report = nlohmann::json::parse(t.read("s.json"));
    check_report("kdbuild-stats", report);
    const auto& mesh = report["mesh"];
    CHECK(mesh["source_triangles"] == 6);
    CHECK(mesh["triangles"] == 2);
    CHECK(mesh["non_finite"] == nlohmann::json{{"count", 2}, {"first", 1}});
    CHECK(mesh["degenerate"] == nlohmann::json{{"count", 1}, {"first", 3}});
    CHECK(mesh["duplicate"] == nlohmann::json{{"count", 1}, {"first", 4}});
    CHECK(mesh["opposite"] == nlohmann::json{{"count", 1}, {"first", 5}});
    CHECK(mesh["collapsed"] == nlohmann::json{{"count", 0}});
  }

  TEST_CASE("a missing MTL is a warning") {
    const Terminal t;
    t.write("m.obj", "mtllib gone.mtl\nusemtl red\n" + kTetrahedronObj);
    const ToolRun run = t.run(kTool, {"build", "m.obj", "-o", "m.nkd", "--quiet", "--stats", "m.json"});
    CHECK(run.status == 0);
    CHECK(run.out == "");
    CHECK(run.err.starts_with("kdbuild: warning: m.obj: "));
    CHECK(run.err.find("gone.mtl") != std::string::npos);
    CHECK(nlohmann::json::parse(t.read("m.json"))["warnings"].size() >= 1);
    CHECK(t.exists("m.nkd"));
  }

  TEST_CASE("--stats - leaves stdout to the report, --quiet leaves it empty") {
    const Terminal t;
    t.report(kTool, {"build", data_file("quad.obj"), "-o", "a.nkd", "--stats", "-"});
    t.report(kTool, {"build", data_file("quad.obj"), "-o", "a.nkd", "--stats", "-", "--quiet"});
    CHECK(t.succeeds(kTool, {"build", data_file("quad.obj"), "-o", "a.nkd", "--quiet"}).out == "");
  }

  TEST_CASE("--help tells of every option and status") {
    const Terminal t;
    const std::string help = t.succeeds(kTool, {"build", "--help"}).out;
    for (const char* option : {"input",
                               "--output",
                               "--bits",
                               "--ambient-from-diffuse",
                               "--stats",
                               "--threads",
                               "--quiet",
                               "--max-error",
                               "--split",
                               "--max-object-size",
                               "--force",
                               "--dry-run",
                               "--depfile",
                               "--jobs",
                               "Advanced",
                               "--traversal-cost",
                               "--intersection-cost",
                               "--empty-bonus",
                               "--max-depth",
                               ".obj",
                               ".ply",
                               ".stl",
                               ".off"}) {
      CHECK_MESSAGE(help.find(option) != std::string::npos, option);
    }
    const std::string top = t.succeeds(kTool, {"--help"}).out;
    for (const char* word : {"build", "info", "validate", "Exit status", "--version"}) {
      CHECK_MESSAGE(top.find(word) != std::string::npos, word);
    }
    CHECK(t.succeeds(kTool, {"--version"}).out.starts_with("kdtrace "));
  }

  TEST_CASE("usage errors") {
    const Terminal t;
    const std::string cube = data_file("cube.obj");
    t.fails(kTool, {}, ErrorClass::usage, {"subcommand"});
    t.fails(kTool, {"build"}, ErrorClass::usage, {"input"});
    t.fails(kTool, {"build", cube}, ErrorClass::usage, {"--output"});
    t.fails(kTool, {"build", cube, "-o", "x.nkd", "--frob"}, ErrorClass::usage, {"--frob"});
    for (const char* bits : {"0", "25", "abc", "-1", "21.5"}) {
      t.fails(kTool, {"build", cube, "-o", "x.nkd", "--bits", bits}, ErrorClass::usage, {"--bits", bits});
    }
    t.fails(kTool, {"build", cube, "-o", "x.nkd", "--threads", "-1"}, ErrorClass::usage, {"--threads", "-1"});
  }

  TEST_CASE("a name of - is stdout for reports, and refused for what is no report") {
    const Terminal t;
    t.write("a.obj", kTetrahedronObj);
    t.succeeds(kTool, {"build", "a.obj", "-o", "a.nkd"});
    t.fails(kTool, {"info", "a.nkd", "--plot", "-"}, ErrorClass::usage, {"--plot", "stdout", "./-"});
    t.fails(kTool, {"build", "a.obj", "-o", "-"}, ErrorClass::usage, {"--output", "stdout"});
    t.fails(kTool, {"build", "a.obj", "-o", "b.nkd", "--depfile", "-"}, ErrorClass::usage, {"--depfile", "stdout"});
    t.fails("kdbench", {"sweep", "a.obj", "--camera", "c", "--csv", "-"}, ErrorClass::usage, {"--csv", "stdout"});
    CHECK(!t.exists("-"));
    t.succeeds(kTool, {"info", "a.nkd", "--plot", "./-"});
    CHECK(t.read("-").starts_with("<svg"));
  }

  TEST_CASE("an unknown subcommand is named") {
    Terminal().fails(kTool, {"frobnicate"}, ErrorClass::usage, {"frobnicate"});
  }

  TEST_CASE("inputs that are no mesh") {
    const Terminal t;
    t.write("x.nkd", "what was there before");
    const auto fails = [&](const std::string& mesh, ErrorClass error_class, const std::string& fragment) {
      t.fails(kTool, {"build", mesh, "-o", "x.nkd"}, error_class, {mesh, fragment});
    };
    fails("gone.obj", ErrorClass::missing, "No such file");
    std::filesystem::create_directory(t.path("folder.obj"));
    fails("folder.obj", ErrorClass::missing, "not a regular file");
    t.write("mesh.fbx", kTetrahedronObj);
    fails("mesh.fbx", ErrorClass::mesh, ".ply");
    for (const char* name : {"g.obj", "g.ply", "g.stl", "g.off"}) {
      t.write(name, "");
      fails(name, ErrorClass::mesh, "");
      std::string garbage;
      for (uint32_t i = 0, word = 1; i < 4000; ++i, word = word * 1664525 + 1013904223) append(garbage, word);
      t.write(name, garbage);
      fails(name, ErrorClass::mesh, "");
    }
    t.write("cut.ply", kTetrahedronPly.substr(0, kTetrahedronPly.size() - 12));
    fails("cut.ply", ErrorClass::mesh, "truncated");
    t.write("far.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    fails("far.obj", ErrorClass::mesh, "");
    t.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nf 1 1 2\n");
    fails("flat.obj", ErrorClass::mesh, "0 have a coordinate that is not finite, 2 no area");
    t.write("nan.obj", "v 0 0 0\nv 1 0 0\nv nan 0 0\nf 1 2 3\n");
    fails("nan.obj", ErrorClass::mesh, "");
  }

  TEST_CASE("a pipe with nobody at the other end is refused, not waited for") {
    const Terminal t;
    REQUIRE(mkfifo(t.path("pipe.obj").c_str(), 0600) == 0);
    Conditions conditions;
    conditions.patience = std::chrono::seconds(1);
    t.fails(kTool, {"build", "pipe.obj", "-o", "x.nkd"}, ErrorClass::missing, {"pipe.obj"}, conditions);
  }

  TEST_CASE("outputs that cannot be written") {
    const Terminal t;
    const std::string cube = data_file("cube.obj");
    t.write("file", "regular");
    for (const char* output : {"gone/x.nkd", "file/x.nkd", "file/", "/dev/null"}) {
      t.fails(kTool, {"build", cube, "-o", output}, ErrorClass::output, {output});
    }
    t.fails(kTool, {"build", cube, "-o", ""}, ErrorClass::usage, {"--output", "file name"});
  }

  TEST_CASE("a report that cannot be written is found out before the object is") {
    const Terminal t;
    std::filesystem::create_directory(t.path("folder"));
    t.fails(kTool, {"build", data_file("cube.obj"), "-o", "x.nkd", "--stats", "folder"}, ErrorClass::output,
            {"folder"});
    t.fails(kTool, {"build", data_file("cube.obj"), "-o", "x.nkd", "--stats", "gone/s.json"}, ErrorClass::output,
            {"gone/s.json"});
  }

  TEST_CASE("an output that is the input, or the report, is refused") {
    const Terminal t;
    t.write("mesh.obj", kTetrahedronObj);
    t.fails(kTool, {"build", "mesh.obj", "-o", "mesh.obj"}, ErrorClass::usage, {"mesh.obj"});
    t.fails(kTool, {"build", "mesh.obj", "-o", "x.nkd", "--stats", "x.nkd"}, ErrorClass::usage, {"x.nkd"});
    t.fails(kTool, {"build", "mesh.obj", "-o", "x.nkd", "--stats", "mesh.obj"}, ErrorClass::usage, {"mesh.obj"});
  }

  TEST_CASE("a full disk leaves what was there") {
    const Terminal t;
    t.write("x.nkd", "what was there before");
    Conditions full;
    full.largest_file = 20000;
    t.fails(kTool, {"build", data_file("icosphere.ply"), "-o", "x.nkd", "--quiet"}, ErrorClass::output, {"x.nkd"},
            full);
  }

  TEST_CASE("a report that stdout does not take is an error") {
    const Terminal t;
    Conditions full;
    full.stdout_file = "/dev/full";
    const ToolRun run = t.run(kTool, {"build", data_file("quad.obj"), "-o", "q.nkd", "--stats", "-"}, full);
    CHECK(run.status == static_cast<int>(ErrorClass::output));
  }

  TEST_CASE("names that are not UTF-8 do not stop a report") {
    const Terminal t;
    t.write("caf\xe9.obj", kTetrahedronObj);
    const auto report = t.report(kTool, {"build", "caf\xe9.obj", "-o", "x.nkd", "--stats", "-"});
    CHECK(report["mesh"]["triangles"] == 4);
  }

  TEST_CASE("a warning is one line, whatever the file's name") {
    const Terminal t;
    t.write("two\nlines.obj", "mtllib gone.mtl\n" + kTetrahedronObj);
    const ToolRun run = t.run(kTool, {"build", "two\nlines.obj", "-o", "x.nkd", "--quiet"});
    CHECK(run.status == 0);
    CHECK_MESSAGE(run.err.find("two\nlines") == std::string::npos, run.err);
  }

  TEST_CASE("the same input gives the same bytes for any number of threads") {
    const Terminal t;
    t.write("grid.ply", grid_ply(120));
    for (const std::string& mesh : {std::string("grid.ply"), data_file("cathedral_pier.obj")}) {
      std::set<std::string> objects;
      for (const char* threads : {"1", "2", "8", "8"}) {
        t.succeeds(kTool, {"build", mesh, "-o", "x.nkd", "--threads", threads});
        objects.insert(t.read("x.nkd"));
      }
      CHECK(objects.size() == 1);
    }
  }

  TEST_CASE("interrupted or killed, it leaves nothing") {
    const Terminal t;
    t.write("grid.ply", grid_ply(866));    // 1.5 million triangles
    for (const int after : {150, 1800}) {  // while it reads; while it builds
      Conditions conditions;
      conditions.signal = SIGINT;
      conditions.signal_after = std::chrono::milliseconds(after);
      t.fails(kTool, {"build", "grid.ply", "-o", "x.nkd", "--threads", "1"}, ErrorClass::interrupted, {"grid.ply"},
              conditions);
    }
    // Text of some seconds' reading.
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (int i = 0; i < 6'000'000; ++i) text += "f 1 2 3\n";
    t.write("long.obj", text);
    for (const int after : {100, 300, 700}) {
      Conditions conditions;
      conditions.signal = SIGINT;
      conditions.signal_after = std::chrono::milliseconds(after);
      const auto start = std::chrono::steady_clock::now();
      t.fails(kTool, {"build", "long.obj", "-o", "x.nkd"}, ErrorClass::interrupted, {"long.obj"}, conditions);
      CHECK(std::chrono::steady_clock::now() - start < conditions.signal_after + std::chrono::seconds(15));
    }
    Conditions killed;
    killed.signal = SIGKILL;
    killed.signal_after = std::chrono::milliseconds(500);
    CHECK(t.run(kTool, {"build", "grid.ply", "-o", "x.nkd"}, killed).status == -SIGKILL);
    CHECK(!t.exists("x.nkd"));
  }
}
