// kdbuild build as a part of a build: many meshes, what is up to date, and what build systems are told.
#include <csignal>
#include <cstdlib>
#include <filesystem>

#include <doctest/doctest.h>

#include "cli/json_schema.h"
#include "cli/meshes.h"
#include "cli/run_tool.h"

using namespace kd;
using namespace kd::test;

namespace {

namespace fs = std::filesystem;

constexpr const char* kTool = "kdbuild";

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Three meshes; c.obj has materials.
void write_meshes(const Terminal& t) {
  t.write("a.obj", kTetrahedronObj);
  t.write("b.ply", grid_ply(20));
  t.write("c.obj", "mtllib c.mtl\nusemtl red\n" + kTetrahedronObj);
  t.write("c.mtl", "newmtl red\nKd 1 0 0\n");
}

const Arguments kBuildThree{"build", "a.obj", "b.ply", "c.obj", "-o", "out/"};

Arguments operator+(Arguments arguments, const Arguments& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

}  // namespace

TEST_SUITE("kdbuild build of many") {
  TEST_CASE("each input becomes an object of its name, told of in order") {
    const Terminal t;
    write_meshes(t);
    const std::string out = t.succeeds(kTool, kBuildThree + Arguments{"--jobs", "3"}).out;
    const size_t a = out.find("a.obj -> out/a.nkd\n  4 triangles"), b = out.find("b.ply -> out/b.nkd\n  800 triangles"),
                 c = out.find("c.obj -> out/c.nkd\n  4 triangles");
    CHECK_MESSAGE((a < b && b < c && c != std::string::npos), out);
    t.succeeds(kTool, {"validate", "out/a.nkd", "out/b.nkd", "out/c.nkd"});
    CHECK(t.succeeds(kTool, kBuildThree + Arguments{"--force", "--quiet"}).out == "");
  }

  TEST_CASE("the bytes are the same for any number of jobs, and for one input at a time") {
    const Terminal t;
    write_meshes(t);
    t.succeeds(kTool, kBuildThree + Arguments{"--jobs", "1"});
    const auto one = t.snapshot();
    for (const Arguments& how : {Arguments{"--jobs", "8"}, Arguments{"--jobs", "8", "--threads", "1"}}) {
      t.succeeds(kTool, kBuildThree + how + Arguments{"--force"});
      CHECK(t.snapshot() == one);
      for (const char* object : {"out/a.nkd", "out/b.nkd", "out/c.nkd"}) {
        CHECK(fs::status(t.path(object)).permissions() == fs::status(t.path("a.obj")).permissions());
      }
    }
    t.succeeds(kTool, {"build", "b.ply", "-o", "alone.nkd"});
    CHECK(t.read("alone.nkd") == t.read("out/b.nkd"));
  }

  TEST_CASE("a folder that exists needs no slash, and one input may go to a folder too") {
    const Terminal t;
    write_meshes(t);
    fs::create_directory(t.path("there"));
    t.succeeds(kTool, {"build", "a.obj", "-o", "there"});
    t.succeeds(kTool, {"build", "a.obj", "-o", "made/deep/"});
    CHECK(t.read("there/a.nkd") == t.read("made/deep/a.nkd"));
  }

  TEST_CASE("names with spaces, dots and other alphabets") {
    const Terminal t;
    t.write("my chair.v2.obj", kTetrahedronObj);
    t.write("стул.obj", kTetrahedronObj);
    t.succeeds(kTool, {"build", "my chair.v2.obj", "стул.obj", "-o", "out folder/", "--quiet"});
    t.succeeds(kTool, {"validate", "out folder/my chair.v2.nkd", "out folder/стул.nkd"});
  }

  TEST_CASE("a bad input fails alone, and the first one's status is the run's") {
    const Terminal t;
    write_meshes(t);
    t.write("empty.off", "");
    const ToolRun run = t.run(kTool, {"build", "a.obj", "empty.off", "gone.stl", "c.obj", "-o", "out/", "--stats",
                                      "s.json", "--jobs", "2", "--quiet"});
    CHECK(run.status == static_cast<int>(ErrorClass::mesh));
    CHECK(run.out == "");
    CHECK_MESSAGE(run.err.starts_with("kdbuild: error: empty.off"), run.err);
    CHECK_MESSAGE(has(run.err, "\nkdbuild: error: gone.stl: cannot open: No such file or directory\n"), run.err);
    CHECK_MESSAGE(run.err.ends_with("\nkdbuild: 2 of 4 failed\n"), run.err);
    t.succeeds(kTool, {"validate", "out/a.nkd", "out/c.nkd"});
    CHECK(!t.exists("out/empty.nkd"));

    const auto report = nlohmann::json::parse(t.read("s.json"));
    check_report("kdbuild-stats", report);
    CHECK(report["objects"].size() == 2);
    REQUIRE(report["failed"].size() == 2);
    CHECK(report["failed"][0]["status"] == 4);
    CHECK(report["failed"][1]["input"] == "gone.stl");
    CHECK(report["totals"]["inputs"] == 4);
    CHECK(report["totals"]["triangles"] == 8);
  }

  TEST_CASE("inputs and outputs that cannot be") {
    const Terminal t;
    write_meshes(t);
    fs::create_directory(t.path("more"));
    t.write("more/a.ply", grid_ply(2));
    t.write("file", "regular");
    t.fails(kTool, {"build", "a.obj", "b.ply", "-o", "x.nkd"}, ErrorClass::usage, {"x.nkd", "2 inputs", "folder"});
    t.fails(kTool, {"build", "a.obj", "more/a.ply", "-o", "out/"}, ErrorClass::usage,
            {"out/a.nkd", "a.obj", "more/a.ply"});
    t.fails(kTool, {"build", "a.obj", "a.obj", "-o", "out/"}, ErrorClass::usage, {"out/a.nkd"});
    t.fails(kTool, {"build", "a.obj", "b.ply", "-o", "file/"}, ErrorClass::output, {"file/"});
    t.fails(kTool, {"build", "a.obj", "b.ply", "-o", "/proc/out/"}, ErrorClass::output, {"/proc/out/"});
    t.fails(kTool, {"build", "c.obj", "-o", "c.mtl"}, ErrorClass::usage, {"c.mtl", "input"});
    t.fails(kTool, {"build", "c.obj", "-o", "x.nkd", "--depfile", "c.mtl"}, ErrorClass::usage, {"c.mtl", "input"});
    t.fails(kTool, {"build", "a.obj", "-o", "x.nkd", "--depfile", "x.nkd"}, ErrorClass::usage, {"x.nkd"});
    for (const char* jobs : {"0", "-1", "many", "1.5"}) {
      t.fails(kTool, {"build", "a.obj", "-o", "x.nkd", "--jobs", jobs}, ErrorClass::usage, {"--jobs", jobs});
    }
  }

  TEST_CASE("interrupted, it stops all and leaves nothing half-written") {
    const Terminal t;
    t.write("small.obj", kTetrahedronObj);
    for (const char* name : {"x.ply", "y.ply", "z.ply"}) t.write(name, grid_ply(866));
    Conditions conditions;
    conditions.signal = SIGINT;
    conditions.signal_after = std::chrono::milliseconds(1200);
    const ToolRun run =
        t.run(kTool, {"build", "small.obj", "x.ply", "y.ply", "z.ply", "-o", "out/", "--jobs", "2", "--threads", "1"},
              conditions);
    CHECK(run.status == static_cast<int>(ErrorClass::interrupted));
    CHECK(run.err == "kdbuild: error: interrupted: 1 of 4 done\n");
    CHECK(has(run.out, "small.obj -> out/small.nkd"));
    size_t files = 0;
    for (const auto& entry : fs::directory_iterator(t.path("out"))) {
      CHECK(entry.path().filename() == "small.nkd");
      ++files;
    }
    CHECK(files == 1);
  }
}

TEST_SUITE("kdbuild build, what is up to date") {
  TEST_CASE("is left alone, until the source, a file it names or a setting changes") {
    const Terminal t;
    write_meshes(t);
    t.succeeds(kTool, kBuildThree);
    const auto first = fs::last_write_time(t.path("out/c.nkd"));
    for (const char* file : {"a.obj", "c.obj", "c.mtl"})
      fs::last_write_time(t.path(file), fs::file_time_type::clock::now());
    const ToolRun again = t.succeeds(kTool, kBuildThree);
    CHECK(again.out ==
          "a.obj -> out/a.nkd: up to date\nb.ply -> out/b.nkd: up to date\nc.obj -> out/c.nkd: up to date\n");
    CHECK(fs::last_write_time(t.path("out/c.nkd")) == first);

    const auto why = [&](const Arguments& more = {}) {
      return t.succeeds(kTool, kBuildThree + more + Arguments{"--dry-run"}).out;
    };
    t.write("c.mtl", "newmtl red\nKd 0 1 0\n");
    CHECK(has(why(), "c.obj -> out/c.nkd: to build (the source changed)\n"));
    CHECK(has(why(), "a.obj -> out/a.nkd: up to date\n"));
    fs::remove(t.path("c.mtl"));
    CHECK(has(why(), "c.obj -> out/c.nkd: to build (the source changed)\n"));
    t.write("c.mtl", "newmtl red\nKd 1 0 0\n");
    CHECK(has(why(), "c.obj -> out/c.nkd: up to date\n"));
    CHECK(has(why({"--bits", "20"}), "b.ply -> out/b.nkd: to build (the settings changed: they were --bits 21)\n"));
    CHECK(has(why({"--ambient-from-diffuse"}), "c.obj -> out/c.nkd: to build (the settings"));
    CHECK(has(why({"--threads", "3"}), "b.ply -> out/b.nkd: up to date\n"));
    CHECK(has(why({"--force"}), "b.ply -> out/b.nkd: to build (--force)\n"));
  }

  TEST_CASE("an old output that is unsound is built anew") {
    const Terminal t;
    write_meshes(t);
    t.succeeds(kTool, kBuildThree);
    const std::string good = t.read("out/b.nkd");
    std::string flipped = good;
    flipped[good.size() / 2] = static_cast<char>(flipped[good.size() / 2] ^ 1);
    for (const std::string& bad : {std::string(), std::string("no object"), good.substr(0, good.size() / 2), flipped}) {
      t.write("out/b.nkd", bad);
      CHECK(has(t.succeeds(kTool, kBuildThree + Arguments{"--dry-run"}).out,
                "b.nkd: to build (the output is no sound object)"));
      t.succeeds(kTool, kBuildThree);
      CHECK(t.read("out/b.nkd") == good);
    }
  }

  TEST_CASE("a dry run touches nothing, says why, and has no report") {
    const Terminal t;
    write_meshes(t);
    const auto before = t.snapshot();
    CHECK(has(t.succeeds(kTool, kBuildThree + Arguments{"--dry-run"}).out,
              "a.obj -> out/a.nkd: to build (there is no output)\n"));
    const ToolRun missing = t.run(kTool, {"build", "gone.obj", "a.obj", "-o", "out/", "--dry-run"});
    CHECK(missing.status == static_cast<int>(ErrorClass::missing));
    CHECK(has(missing.out, "a.obj -> out/a.nkd: to build"));
    CHECK(t.snapshot() == before);
    for (const char* option : {"--stats", "--depfile"}) {
      t.fails(kTool, kBuildThree + Arguments{"--dry-run", option, "x"}, ErrorClass::usage, {"--dry-run", option});
    }
  }

  TEST_CASE("is in the report, with what the object says of itself") {
    const Terminal t;
    write_meshes(t);
    const Arguments build{"build", "b.ply", "-o", "b.nkd", "--stats", "-"};
    const auto built = t.report(kTool, build), found = t.report(kTool, build);
    check_report("kdbuild-stats", built);
    check_report("kdbuild-stats", found);
    CHECK(built["up_to_date"] == false);
    CHECK(found["up_to_date"] == true);
    for (const char* key : {"lattice", "error", "tree", "bytes", "settings", "input", "output"})
      CHECK(built[key] == found[key]);
    CHECK(built["mesh"]["vertices"] == found["mesh"]["vertices"]);
    CHECK(found["seconds"]["build"] == 0);

    t.succeeds(kTool, kBuildThree);
    t.write("a.obj", "# another\n" + kTetrahedronObj);
    const auto many = t.report(kTool, kBuildThree + Arguments{"--stats", "-"});
    check_report("kdbuild-stats", many);
    CHECK(many["up_to_date"] == nlohmann::json{"b.ply", "c.obj"});
    REQUIRE(many["objects"].size() == 3);
    CHECK(many["objects"][0]["up_to_date"] == false);
    CHECK(many["objects"][1]["tree"] == built["tree"]);
    CHECK(many["totals"]["objects"] == 3);
  }
}

TEST_SUITE("kdbuild build, for build systems") {
  TEST_CASE("a depfile names what each output is made of, built or not") {
    const Terminal t;
    write_meshes(t);
    t.write("odd $name #1: x.obj", "mtllib gone.mtl c.mtl\n" + kTetrahedronObj);
    const std::string expected =
        "out/a.nkd: a.obj\nout/b.nkd: b.ply\nout/c.nkd: c.obj c.mtl\n"
        "out/odd\\ $$name\\ \\#1\\:\\ x.nkd: odd\\ $$name\\ \\#1\\:\\ x.obj c.mtl\n";
    for (int pass = 0; pass < 2; ++pass) {
      const ToolRun run =
          t.run(kTool, {"build", "a.obj", "b.ply", "c.obj", "odd $name #1: x.obj", "-o", "out/", "--depfile", "all.d"});
      CHECK(run.status == 0);
      CHECK(t.read("all.d") == expected);
    }
    t.fails(kTool, {"build", "a.obj", "-o", "a.nkd", "--depfile", "gone/x.d"}, ErrorClass::output, {"gone/x.d"});
  }

  TEST_CASE("make understands a depfile") {
    const Terminal t;
    write_meshes(t);
    t.write("my mesh.obj", "mtllib c.mtl\n" + kTetrahedronObj);
    t.succeeds(kTool, {"build", "my mesh.obj", "-o", "my mesh.nkd", "--depfile", "d"});
    t.write("Makefile", "include d\nmy\\ mesh.nkd: ; @echo made of '$^'\n");
    fs::last_write_time(t.path("c.mtl"), fs::file_time_type::clock::now() + std::chrono::seconds(2));
    const auto told = system_output("make", "-C '" + t.path("") + "'");
    if (told) CHECK_MESSAGE(has(*told, "made of my mesh.obj c.mtl\n"), *told);
  }

  TEST_CASE("docs/build.ninja compiles data/, twice without work, and again what has changed") {
    const Terminal t;
    fs::create_directory(t.path("data"));
    for (const char* extension : {".obj", ".ply", ".mtl"}) {
      for (const auto& entry : fs::directory_iterator(source_root() / "data")) {
        if (entry.path().extension() == extension) fs::copy(entry.path(), t.path("data"));
      }
    }
    fs::copy(source_root() / "docs" / "build.ninja", t.path("build.ninja"));
    setenv("PATH", (std::string(KD_BIN_DIR) + ":" + std::getenv("PATH")).c_str(), 1);
    const auto ninja = [&t] { return system_output("ninja", "-C '" + t.path("") + "'"); };
    const auto first = ninja();
    if (!first) return;
    CHECK(has(*first, "[18/18]"));
    const auto built = t.snapshot();
    CHECK(has(*ninja(), "no work to do"));

    const auto time_of = [&t](const char* name) { return fs::last_write_time(t.path(name)); };
    const auto pew = time_of("data/compiled/pew.nkd"), altar = time_of("data/compiled/altar.nkd");
    fs::last_write_time(t.path("data/altar.obj"), fs::file_time_type::clock::now());
    t.write("data/pew.obj", "# changed\n" + t.read("data/pew.obj"));
    CHECK(has(*ninja(), "[2/2]"));
    CHECK(time_of("data/compiled/pew.nkd") > pew);
    CHECK(time_of("data/compiled/altar.nkd") == altar);
    CHECK(t.read("data/compiled/altar.nkd") == built.at("data/compiled/altar.nkd"));
    CHECK(has(*ninja(), "no work to do"));
    t.write("data/materials.mtl", t.read("data/materials.mtl") + "\n");
    CHECK(has(*ninja(), "[17/17]"));  // all but the icosphere name it
    CHECK(has(*ninja(), "no work to do"));
  }
}
