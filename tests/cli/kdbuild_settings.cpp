// kdbuild build: the settings that shape objects, and sources that become several.
#include <cmath>
#include <filesystem>
#include <set>

#include <doctest/doctest.h>

#include "cli/json_schema.h"
#include "cli/meshes.h"
#include "cli/run_tool.h"
#include "kdbuild/build_source.h"
#include "kdbuild/estimate.h"
#include "mesh/lattice_fit.h"
#include "mesh/normalise.h"
#include "mesh/read_mesh.h"
#include "support/temp_folder.h"

using namespace kd;
using namespace kd::test;

namespace {

constexpr const char* kTool = "kdbuild";

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Two materials that share an edge, and one that no face uses.
const std::string kTwoMaterials =
    "mtllib m.mtl\nv 0 0 0\nv 3 0 0\nv 3 2 0\nv 0 2 1\nv 6 1 0\n"
    "usemtl red\nf 1 2 3\nf 1 3 4\nusemtl green\nf 2 5 3\n";
const std::string kMtl = "newmtl red\nKd 1 0 0\nnewmtl green\nKd 0 1 0\nnewmtl blue\nKd 0 0 1\n";

nlohmann::json info(const Terminal& t, const std::string& object) {
  return t.report(kTool, {"info", object, "--format", "json"});
}

}  // namespace

TEST_SUITE("kdbuild build --max-error") {
  TEST_CASE("picks the fewest bits that keep the error") {
    const Terminal t;
    const std::string mesh = data_file("cathedral_pier.obj");
    std::map<int, double> error_of;
    for (int bits = 10; bits <= 24; ++bits) {
      error_of[bits] = t.report(
          kTool, {"build", mesh, "-o", "x.nkd", "--bits", std::to_string(bits), "--stats", "-"})["error"]["max"];
    }
    for (const char* allowed : {"1", "0.01", "0.001", "3e-5", "1e-6"}) {
      const auto report = t.report(kTool, {"build", mesh, "-o", "x.nkd", "--max-error", allowed, "--stats", "-"});
      check_report("kdbuild-stats", report);
      const double limit = std::stod(allowed);
      const int bits = report["lattice"]["bits"];
      const double error = report["error"]["max"];
      CHECK(error <= limit);
      // Without a limit a vertex may go further, if its faces gain by it.
      CHECK(error <= error_of[bits]);
      if (bits > 10) CHECK(error_of[bits - 1] > limit);
      CHECK(error_of[bits] <= 3 * limit);
      CHECK(report["error"]["allowed"] == limit);
    }
    const ToolRun text = t.succeeds(kTool, {"build", mesh, "-o", "x.nkd", "--max-error", "0.01"});
    CHECK_MESSAGE(has(text.out, " bits (the fewest for 0.01), largest displacement"), text.out);
    CHECK(has(t.succeeds(kTool, {"build", mesh, "-o", "x.nkd", "--max-error", "0.01"}).out, "up to date"));
    CHECK(has(t.succeeds(kTool, {"info", "x.nkd"}).out, "with --max-error 0.01"));
  }

  TEST_CASE("says what can be had if it cannot be kept") {
    const Terminal t;
    const std::string mesh = data_file("cathedral_pier.obj");
    t.fails(kTool, {"build", mesh, "-o", "x.nkd", "--max-error", "1e-12"}, ErrorClass::usage,
            {mesh, "--max-error 1e-12", "24 bits", "e-0"});
    for (const char* value : {"0", "-1", "nan", "inf", "much"}) {
      t.fails(kTool, {"build", mesh, "-o", "x.nkd", "--max-error", value}, ErrorClass::usage, {"--max-error"});
    }
    t.fails(kTool, {"build", mesh, "-o", "x.nkd", "--max-error", "1", "--bits", "12"}, ErrorClass::usage,
            {"--max-error", "--bits"});
  }
}

TEST_SUITE("kdbuild build --vertices") {
  TEST_CASE("float32 stores 12 bytes a vertex over the same triangles, and says so everywhere") {
    const Terminal t;
    const std::string mesh = data_file("icosphere.ply");
    const auto lattice = t.report(kTool, {"build", mesh, "-o", "l.nkd", "--bits", "24", "--stats", "-"});
    const auto report = t.report(kTool, {"build", mesh, "-o", "f.nkd", "--vertices", "float32", "--stats", "-"});
    check_report("kdbuild-stats", report);
    CHECK(report["settings"] == "--bits 24 --vertices float32");
    CHECK(report["lattice"] == lattice["lattice"]);
    CHECK(report["mesh"] == lattice["mesh"]);
    // Its vertices go to the nearest points.
    CHECK(report["tree"]["sah_cost"].get<double>() ==
          doctest::Approx(lattice["tree"]["sah_cost"].get<double>()).epsilon(1e-2));
    CHECK(report["error"]["max"] > 0);
    CHECK(report["error"]["max"] <= lattice["error"]["max"]);
    CHECK(report["error"]["rms"] < lattice["error"]["rms"]);
    const auto found = info(t, "f.nkd");
    CHECK(found["vertex_form"] == "float32");
    CHECK(found["sections"]["vertices"] == 12 * 642 + kTripleMargin);
    CHECK(info(t, "l.nkd")["vertex_form"] == "lattice");
    CHECK(has(t.succeeds(kTool, {"info", "f.nkd"}).out, "24 bits an axis; vertices in float32"));
    CHECK_FALSE(has(t.succeeds(kTool, {"info", "l.nkd"}).out, "float32"));
    CHECK(has(t.succeeds(kTool, {"build", mesh, "-o", "g.nkd", "--vertices", "float32", "--bits", "24"}).out,
              "lattice: 24 bits, vertices in float32, largest displacement"));
    CHECK(t.read("g.nkd") == t.read("f.nkd"));
    const std::string sound = t.succeeds(kTool, {"validate", "f.nkd"}).out;
    CHECK_MESSAGE(sound.starts_with("f.nkd: sound (vertices in float32: "), sound);
    const auto verdict = t.report(kTool, {"validate", "f.nkd", "l.nkd", "--format", "json"});
    CHECK(verdict["files"][0]["vertex_form"] == "float32");
    CHECK(verdict["files"][1]["vertex_form"] == "lattice");
  }

  TEST_CASE("changing it builds anew") {
    const Terminal t;
    const std::string mesh = data_file("cube.obj");
    const auto build = [&](const Arguments& more) {
      Arguments all{"build", mesh, "-o", "x.nkd"};
      all.insert(all.end(), more.begin(), more.end());
      return t.succeeds(kTool, all).out;
    };
    build({"--bits", "24"});
    CHECK(has(build({"--bits", "24", "--vertices", "lattice"}), "up to date"));
    CHECK_FALSE(has(build({"--vertices", "float32"}), "up to date"));
    CHECK(has(build({"--vertices", "float32"}), "up to date"));
    CHECK(has(build({"--bits", "24", "--dry-run"}), "the settings changed: they were --bits 24 --vertices float32"));
    CHECK_FALSE(has(build({"--bits", "24"}), "up to date"));
  }

  TEST_CASE("float32 with another lattice, and what is no form") {
    const Terminal t;
    const std::string mesh = data_file("cube.obj");
    const auto fails = [&](const Arguments& more, const std::vector<std::string>& fragments) {
      Arguments all{"build", mesh, "-o", "x.nkd", "--vertices"};
      all.insert(all.end(), more.begin(), more.end());
      t.fails(kTool, all, ErrorClass::usage, fragments);
    };
    fails({"float32", "--bits", "21"}, {"--vertices float32", "--bits 21", "24"});
    fails({"float32", "--max-error", "1"}, {"--vertices float32", "--max-error"});
    fails({"float64"}, {"--vertices", "float64"});
    t.succeeds(kTool, {"build", mesh, "-o", "x.nkd", "--vertices", "lattice", "--max-error", "1"});
  }
}

TEST_SUITE("kdbuild build, tree settings") {
  TEST_CASE("change the tree, are recorded, and only if they are not the default") {
    const Terminal t;
    const std::string mesh = data_file("icosphere.ply");
    const auto build = [&](const Arguments& more) {
      Arguments all{"build", mesh, "-o", "x.nkd", "--stats", "-"};
      all.insert(all.end(), more.begin(), more.end());
      return t.report(kTool, all);
    };
    const auto standard = build({});
    const std::string bytes = t.read("x.nkd");
    CHECK(standard["settings"] == "--bits 21");
    CHECK(build({"--max-depth", "64", "--traversal-cost", "1", "--intersection-cost", "1.5", "--empty-bonus", "0.08",
                 "--byte-price", "0.35"})["up_to_date"] == true);
    for (const Arguments& setting :
         {Arguments{"--max-depth", "5"}, Arguments{"--traversal-cost", "20"}, Arguments{"--intersection-cost", "0.2"},
          Arguments{"--empty-bonus", "0.8"}, Arguments{"--byte-price", "0"}}) {
      const auto report = build(setting);
      CHECK(report["settings"] == "--bits 21 " + setting[0] + " " + setting[1]);
      CHECK(report["tree"] != standard["tree"]);
      t.succeeds(kTool, {"validate", "x.nkd"});
    }
    CHECK(build({"--max-depth", "5"})["tree"]["depth"] <= 5);
    build({});
    CHECK(t.read("x.nkd") == bytes);
  }

  TEST_CASE("out of range") {
    const Terminal t;
    const auto fails = [&](const char* option, const char* value) {
      t.fails(kTool, {"build", data_file("cube.obj"), "-o", "x.nkd", option, value}, ErrorClass::usage,
              {option, value});
    };
    fails("--max-depth", "65");
    fails("--max-depth", "-1");
    fails("--traversal-cost", "0");
    fails("--intersection-cost", "-2");
    fails("--intersection-cost", "nan");
    fails("--empty-bonus", "1");
    fails("--split", "halves");
    fails("--max-object-size", "100");
    fails("--max-object-size", "9999999999");
  }
}

TEST_SUITE("kdbuild build of several meshes") {
  TEST_CASE("--split material makes a scene of objects on one lattice") {
    const Terminal t;
    t.write("two.obj", kTwoMaterials);
    t.write("m.mtl", kMtl);
    const Arguments build{"build",    "two.obj", "-o",     "out/",      "--split",
                          "material", "--stats", "s.json", "--depfile", "d"};
    const ToolRun run = t.succeeds(kTool, build);
    CHECK_MESSAGE(has(run.out, "two.obj (red) -> out/two.red.nkd\n  2 triangles"), run.out);
    CHECK_MESSAGE(has(run.out, "two.obj -> out/two.json: a scene of 2 objects in 2 parts\n"), run.out);
    CHECK(t.read("d") == "out/two.json: two.obj m.mtl\n");
    const auto red = info(t, "out/two.red.nkd"), green = info(t, "out/two.green.nkd");
    CHECK(red["lattice"] == green["lattice"]);
    CHECK(red["lattice"]["extent"] == nlohmann::json{6.0, 2.0, 1.0});
    const auto report = nlohmann::json::parse(t.read("s.json"));
    check_report("kdbuild-stats", report);
    CHECK(report["objects"][1]["mesh"]["name"] == "green");
    CHECK(report["scenes"] == nlohmann::json::parse(R"([{"input": "two.obj", "output": "out/two.json"}])"));

    const auto scene = nlohmann::json::parse(t.read("out/two.json"));
    CHECK(scene["characters"].size() == 1);
    CHECK(scene["characters"][0]["name"] == "two");
    CHECK(scene["characters"][0]["parts"].size() == 2);
    CHECK(scene["lights"].size() == 1);
    const auto stats = t.run("kdrender", {"out/two.json", "-o", "x.exr", "--device", "cpu"});
    CHECK_MESSAGE(has(stats.out, "2 objects, 2 instances, 3 triangles as seen"), stats.out << stats.err);
  }

  TEST_CASE("a scene is up to date if all its objects are, and its owner may edit the rest") {
    const Terminal t;
    t.write("two.obj", kTwoMaterials);
    t.write("m.mtl", kMtl);
    const Arguments build{"build", "two.obj", "-o", "out/", "--split", "material"};
    const auto why = [&] {
      Arguments dry = build;
      dry.push_back("--dry-run");
      return t.succeeds(kTool, dry).out;
    };
    t.succeeds(kTool, build);
    CHECK(t.succeeds(kTool, build).out == "two.obj -> out/two.json: up to date\n");
    const std::string scene = t.read("out/two.json"), green = t.read("out/two.green.nkd");
    t.write("out/two.json", scene + "\n\n");
    CHECK(has(why(), "up to date"));
    t.write("out/two.json", "{");
    CHECK(has(why(), "the scene cannot be read"));
    t.write("out/two.json", scene);
    std::filesystem::remove(t.path("out/two.green.nkd"));
    CHECK(has(why(), "an output is missing"));
    t.write("out/two.green.nkd", t.read("out/two.red.nkd"));
    CHECK(has(why(), "some of its meshes have no object"));
    t.succeeds(kTool, build);
    CHECK(t.read("out/two.green.nkd") == green);
    t.write("m.mtl", kMtl + "\n");
    CHECK(has(why(), "two.obj -> out/two.json: to build (the source changed)"));
    t.write("m.mtl", kMtl);
    CHECK(has(t.succeeds(kTool, {"build", "two.obj", "-o", "out/", "--dry-run"}).out, "settings changed"));
  }

  TEST_CASE("a mesh of several that is bad fails alone, every time") {
    const Terminal t;
    t.write("m.mtl", kMtl);
    t.write("two.obj", kTwoMaterials + "usemtl blue\nf 1 1 2\n");
    for (int pass = 0; pass < 2; ++pass) {
      const ToolRun run = t.run(kTool, {"build", "two.obj", "-o", "out/", "--split", "material", "--stats", "s.json"});
      CHECK(run.status == static_cast<int>(ErrorClass::mesh));
      CHECK_MESSAGE(run.err.starts_with("kdbuild: error: two.obj: mesh 'blue': nothing is left of its 1 triangles"),
                    run.err);
      const auto report = nlohmann::json::parse(t.read("s.json"));
      check_report("kdbuild-stats", report);
      CHECK(report["objects"].size() == 2);
      CHECK(report["failed"].size() == 1);
      t.succeeds(kTool, {"validate", "out/two.red.nkd", "out/two.green.nkd"});
    }
  }

  TEST_CASE("no object is written over another output or an input") {
    const Terminal t;
    t.write("two.obj", kTwoMaterials);
    t.write("m.mtl", kMtl);
    t.write("two.red.obj", kTetrahedronObj);
    const ToolRun run =
        t.run(kTool, {"build", "two.red.obj", "two.obj", "-o", "out/", "--split", "material", "--quiet"});
    CHECK(run.status == static_cast<int>(ErrorClass::usage));
    CHECK_MESSAGE(has(run.err, "out/two.red.nkd: two outputs have this name"), run.err);
    CHECK(info(t, "out/two.red.nkd")["triangles"] == 4);
  }
}

TEST_SUITE("kdbuild build --max-object-size") {
  TEST_CASE("what is too large for one object becomes several on one lattice, and says so") {
    const Terminal t;
    t.write("grid.ply", grid_ply(60));
    const Arguments build{"build", "grid.ply", "-o", "out/", "--max-object-size", "70000"};
    const ToolRun run = t.succeeds(kTool, build);
    CHECK_MESSAGE(has(run.out, "grid.ply is too large for one object of 70000 bytes: split into "), run.out);
    const auto scene = nlohmann::json::parse(t.read("out/grid.json"));
    const size_t count = scene["objects"].size();
    CHECK(count >= 3);
    CHECK(scene["characters"][0]["parts"].size() == count);
    size_t triangles = 0;
    std::set<std::string> lattices;
    for (size_t i = 0; i < count; ++i) {
      const std::string file = "out/grid." + std::to_string(i) + ".nkd";
      CHECK(t.read(file).size() <= 70000);
      const auto piece = info(t, file);
      triangles += piece["triangles"].get<size_t>();
      lattices.insert(piece["lattice"].dump());
      t.succeeds(kTool, {"validate", file});
    }
    CHECK(triangles == 7200);
    CHECK(lattices.size() == 1);
    CHECK(!t.exists("out/grid.nkd"));
    CHECK(t.run("kdrender", {"out/grid.json", "-o", "x.exr", "--device", "cpu"}).status == 0);
    CHECK(t.succeeds(kTool, build).out == "grid.ply -> out/grid.json: up to date\n");
    CHECK(has(t.succeeds(kTool, {"build", "grid.ply", "-o", "out/"}).out, "grid.ply -> out/grid.nkd\n"));
  }

  TEST_CASE("what only turns out to be too large when it is built is split then") {
    const Terminal t;
    t.write("grid.ply", grid_ply(60));
    const uint64_t whole = t.report(kTool, {"build", "grid.ply", "-o", "x.nkd", "--stats", "-"})["bytes"]["total"];
    const std::string limit = std::to_string(whole - 1);
    const ToolRun run = t.succeeds(kTool, {"build", "grid.ply", "-o", "out/", "--max-object-size", limit});
    CHECK_MESSAGE(has(run.out, "split into 2 objects"), run.out);
    CHECK(t.read("out/grid.0.nkd").size() + t.read("out/grid.1.nkd").size() > whole / 2);
    CHECK(std::distance(std::filesystem::directory_iterator(t.path("out")), {}) == 3);
  }

  TEST_CASE("samples tell what a tree will take, at any price of memory") {
    const TempFolder folder;
    auto mesh = mesh::read_mesh(folder.write("grid.ply", grid_ply(200)), {});
    REQUIRE(mesh);
    const mesh::Mesh* const meshes[] = {&*mesh};
    const mesh::LatticeFit fit(meshes);
    mesh->lattice_points = fit.place(0, fit.lattice(21));
    const mesh::LatticeMesh on_lattice = mesh::normalise(*mesh, fit.lattice(21));
    double dearest = 1e300;
    for (const double price : {0.0, 0.02, 0.25, 1.0}) {
      build::BuildSettings settings;
      settings.costs.byte_price = price;
      const auto sampled = tools::sampled_tree_bytes(*mesh, on_lattice.lattice, settings, {});
      const auto tree = build::build_tree(on_lattice.lattice, on_lattice.vertices, on_lattice.triangles, settings);
      REQUIRE(sampled);
      REQUIRE(tree);
      const auto bytes = static_cast<double>(tree->nodes.size() * sizeof(Node) + tree->references.size() * 4);
      CHECK(bytes < dearest);
      CHECK(static_cast<double>(*sampled) > 1.0 * bytes);
      CHECK(static_cast<double>(*sampled) < 1.5 * bytes);
      dearest = bytes;
      const tools::SizeEstimate size = tools::estimated_size(*mesh, 21);
      CHECK(static_cast<double>(size.least_tree) < bytes);
      CHECK(static_cast<double>(size.most_tree) > bytes);
      // A whole object is what was said, a few kilobytes apart.
      const auto report = tools::build_object(folder.file("grid.ply"), folder.file("x.nkd"), [&] {
        tools::CompileSettings all;
        all.tree = settings;
        return all;
      }());
      REQUIRE(report);
      CHECK(std::fabs(static_cast<double>(report->bytes - size.rest) - bytes) < 8192);
    }
    const auto cancelled = tools::sampled_tree_bytes(*mesh, on_lattice.lattice, {}, [](double) { return false; });
    REQUIRE_FALSE(cancelled);
    CHECK(cancelled.error().error_class == ErrorClass::interrupted);
  }

  TEST_CASE("a large mesh is split as it must be, whatever memory is worth") {
    const Terminal t;
    t.write("grid.ply", grid_ply(520));  // 540 800 triangles: samples decide
    const uint64_t limit = 14'000'000;
    const auto pieces = [&](const char* price) {
      const auto report = t.report(kTool, {"build", "grid.ply", "-o", "out/", "--force", "--byte-price", price,
                                           "--max-object-size", std::to_string(limit), "--stats", "-"});
      for (const auto& object : report["objects"]) CHECK(object["bytes"]["total"].get<uint64_t>() <= limit);
      return report["objects"].size();
    };
    CHECK(pieces("0.25") == 2);
    CHECK(pieces("0") >= 2);
  }

  TEST_CASE("one that fits is one object, whose settings say what it was allowed") {
    const Terminal t;
    const auto report = t.report(
        kTool, {"build", data_file("icosphere.ply"), "-o", "x.nkd", "--max-object-size", "120000", "--stats", "-"});
    check_report("kdbuild-stats", report);
    CHECK(report["settings"] == "--bits 21 --max-object-size 120000");
    CHECK(t.exists("x.nkd"));
  }
}
