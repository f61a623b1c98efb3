// kdbench pareto, from outside.
#include <sstream>

#include <doctest/doctest.h>

#include "cli/json_schema.h"
#include "cli/run_tool.h"

using namespace kd;
using namespace kd::test;

namespace {

constexpr const char* kCamera = "0.4 0.3 3  0 0 0  0 1 0  45  2 2 2\n";

/// Arguments for the icosphere, small and once.
Arguments small(const Terminal& t, const Arguments& more) {
  t.write("icosphere.txt", kCamera);
  Arguments arguments{
      "pareto", data_file("icosphere.ply"), "--cameras", t.path("."), "--device", "cpu", "--repeat", "1", "--warm-up",
      "0"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

}  // namespace

TEST_SUITE("kdbench pareto") {
  TEST_CASE("the forms, and what must hold of each") {
    const Terminal t;
    const auto report =
        t.report("kdbench", small(t, {"--size", "160x120", "--bits", "10,16,21,24", "--csv", "r.csv", "--json", "-"}));
    check_report("kdbench-pareto", report);
    REQUIRE(report["meshes"].size() == 1);
    const auto& mesh = report["meshes"][0];
    CHECK(mesh["triangles"] == 1280);
    CHECK(mesh["rays"]["primary"] == 160 * 120);
    const auto& forms = mesh["forms"];
    std::vector<std::string> names;
    for (const auto& f : forms) names.push_back(f["name"]);
    CHECK(names == std::vector<std::string>{"float32 MT", "float32 Woop", "B 10", "B 16", "B 21", "B 21 MT",
                                            "B 21 Woop", "B 24"});
    for (const auto& f : forms) {
      const std::string name = f["name"];
      CAPTURE(name);
      for (const auto& [ray_class, speed] : f["mrays_per_second"].items()) CHECK_MESSAGE(speed > 0, ray_class);
      const auto& hits = f["primary_hits"];
      CHECK(hits["pixels"] == 160 * 120);
      CHECK(hits["reference_hits"].get<int>() == hits["missed"].get<int>() + hits["wrong_primitive"].get<int>() +
                                                     hits["coincident"].get<int>() + hits["same"].get<int>());
      CHECK(hits["same"].get<int>() > hits["reference_hits"].get<int>() * 9 / 10);
      CHECK(f["depth_error"]["rms"] <= f["depth_error"]["max"]);
      CHECK(f["surface_error"]["hausdorff"] <= f["surface_error"]["max_displacement"].get<double>() * (1 + 1e-9));
      CHECK(f["aimed_rays"]["rays"] > 1500);
      if (f["triangle_test"] != "exact") continue;
      CHECK(f["aimed_rays"]["missed"] == 0);
      CHECK(f["aimed_rays"]["counted_twice"] == 0);
      CHECK(f["aimed_rays"]["leaks"] == 0);
    }
    // More bits, less error; and a vertex has its bytes.
    for (const auto& [fewer, more] : {std::pair{2, 3}, {3, 4}, {4, 7}}) {
      const auto &a = forms[fewer], &b = forms[more];
      CHECK(a["depth_error"]["rms"] > b["depth_error"]["rms"]);
      CHECK(a["surface_error"]["hausdorff"] > b["surface_error"]["hausdorff"]);
      CHECK(a["normal_error_degrees"]["rms"] > b["normal_error_degrees"]["rms"]);
    }
    CHECK(forms[2]["image_error"]["rmse"] > forms[4]["image_error"]["rmse"]);
    CHECK(forms[2]["image_error"]["flip"] > forms[4]["image_error"]["flip"]);
    CHECK(forms[0]["bytes"]["vertices"] == 12 * 642 + kTripleMargin);
    CHECK(forms[2]["bytes"]["vertices"] == 4 * 642 + kTripleMargin);
    CHECK(forms[4]["bytes"]["vertices"] == 8 * 642 + kTripleMargin);
    CHECK(forms[5]["bytes"] == forms[4]["bytes"]);
    CHECK(mesh["ratios"]["exact_speed_to_moller_trumbore"]["primary"].get<double>() ==
          doctest::Approx(forms[4]["mrays_per_second"]["primary"].get<double>() /
                          forms[5]["mrays_per_second"]["primary"].get<double>()));

    // The CSV has the same figures, a row a form.
    std::istringstream lines(t.read("r.csv"));
    std::vector<std::vector<std::string>> rows;
    for (std::string line; std::getline(lines, line);) {
      std::istringstream cells(line);
      rows.emplace_back();
      for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
    }
    REQUIRE(rows.size() == 1 + forms.size());
    const auto column = [&](const std::string& head) {
      return static_cast<size_t>(std::find(rows[0].begin(), rows[0].end(), head) - rows[0].begin());
    };
    for (size_t i = 0; i < forms.size(); ++i) {
      REQUIRE(rows[i + 1].size() == rows[0].size());
      CHECK(rows[i + 1][column("mesh")] == "icosphere");
      CHECK(rows[i + 1][column("form")] == forms[i]["name"]);
      CHECK(std::stod(rows[i + 1][column("depth_rms_steps21")]) ==
            doctest::Approx(forms[i]["depth_error_steps_21"]["rms"].get<double>()));
      CHECK(std::stod(rows[i + 1][column("flip")]) == doctest::Approx(forms[i]["image_error"]["flip"].get<double>()));
      CHECK(std::stoull(rows[i + 1][column("leaks")]) == forms[i]["aimed_rays"]["leaks"]);
    }
  }

  TEST_CASE("errors repeat from run to run, whatever the times do") {
    const Terminal t;
    const auto errors = [&] {
      auto report = t.report("kdbench", small(t, {"--size", "64x48", "--bits", "12", "--json", "-"}));
      for (auto& f : report["meshes"][0]["forms"]) f.erase("mrays_per_second");
      return report["meshes"];
    };
    CHECK(errors() == errors());
  }

  TEST_CASE("a table for each mesh; the ratios only where the default bits are measured") {
    const Terminal t;
    const std::string out = t.succeeds("kdbench", small(t, {"--size", "32x32", "--bits", "10,21"})).out;
    for (const char* text :
         {"|    icosphere |", "|   float32 MT |", "B 10 |", "B 21 Woop |", "exact / Moller-Trumbore"})
      CHECK_MESSAGE(out.find(text) != std::string::npos, text);
    const std::string without = t.succeeds("kdbench", small(t, {"--size", "32x32", "--bits", "10"})).out;
    CHECK(without.find("exact / Moller-Trumbore") == std::string::npos);
  }

  TEST_CASE("errors") {
    const Terminal t;
    t.fails("kdbench", small(t, {"--bits", "0"}), ErrorClass::usage, {"--bits"});
    t.fails("kdbench", small(t, {"--bits", "10,25"}), ErrorClass::usage, {"--bits"});
    t.fails("kdbench", small(t, {"--size", "10"}), ErrorClass::usage, {"--size"});
    t.fails("kdbench", small(t, {"--csv", "gone/r.csv"}), ErrorClass::output, {"gone/r.csv"});
    t.fails("kdbench", small(t, {"--csv", "icosphere.txt"}), ErrorClass::usage, {"icosphere.txt"});
    t.fails("kdbench", {"pareto", data_file("icosphere.ply"), "--cameras", "nowhere"}, ErrorClass::missing,
            {"nowhere/icosphere.txt"});
    t.fails("kdbench", {"pareto", "gone.ply", "--cameras", t.path(".")}, ErrorClass::missing, {"gone"});
  }
}
