// kdbench paper, from outside.
#include <functional>

#include <doctest/doctest.h>

#include "cli/json_schema.h"
#include "cli/run_tool.h"

using namespace kd;
using namespace kd::test;

namespace {

/// spheres.json with another film, and whatever else is replaced.
void write_scene(const Terminal& t, const std::string& film, const std::function<void(nlohmann::json&)>& edit = {}) {
  auto scene = nlohmann::json::parse(t.read("spheres.json"));
  scene["film"] = nlohmann::json::parse(film);
  if (edit) edit(scene);
  t.write("scene.json", scene.dump());
}

nlohmann::json measure(const Terminal& t, const Arguments& more = {}) {
  Arguments arguments{"paper", "scene.json", "--device", "cpu", "--repeat", "1", "--warm-up", "0", "--json", "-"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const auto report = t.report("kdbench", arguments);
  check_report("kdbench-paper", report);
  REQUIRE(report["steps"].size() == 5);
  for (const auto& step : report["steps"]) CHECK_MESSAGE(step["differing_words"] == 0, step.dump());
  return report;
}

std::vector<std::string> stages_of(const nlohmann::json& step) {
  std::vector<std::string> stages;
  for (const auto& stage : step["stages"]) stages.push_back(stage["stage"]);
  return stages;
}

}  // namespace

TEST_SUITE("kdbench paper") {
  TEST_CASE("every step has the same film") {
    Terminal t;
    t.set_up_spheres();
    write_scene(t, R"({"width": 97, "height": 61})");
    const auto report = measure(t, {"--gamma-exr"});
    CHECK(report["instances"] == 5);
    CHECK(report["lights"] == 2);
    const auto& dense = report["steps"][0];
    CHECK(stages_of(dense) == std::vector<std::string>{"ray generation", "object intersection",
                                                       "intersection reduction", "ambient", "shadow rays", "shadow",
                                                       "shadow reduction", "colour", "gamma"});
    CHECK(dense["stages"][2]["launches"] == 3);  // 5, 3, 2, 1
    CHECK(dense["stages"][7]["launches"] == 2);
    // A ray, five hits, two shadow rays and ten tests, then a hit and a pixel of the film.
    CHECK(dense["frame_bytes"] == 97 * 61 * (64 + 5 * 32 + 2 * 64 + 10 + 32 + 16));
    CHECK(report["steps"][1]["frame_bytes"] == 97 * 61 * (64 + 2 * 64 + 2 + 32 + 16));
    CHECK(report["steps"][4]["frame_bytes"] == 97 * 61 * (32 + 16));
    CHECK(stages_of(report["steps"][4]) == std::vector<std::string>{"object intersection", "shadow, colour", "gamma"});
  }

  TEST_CASE("in strips, the last of them short") {
    Terminal t;
    t.set_up_spheres();
    write_scene(t, R"({"width": 130, "height": 99})");
    const auto report = measure(t, {"--buffers", "1"});
    CHECK(report["steps"][0]["strips"] == 5);  // of 20 rows, where 22 would fit
    CHECK(report["steps"][0]["frame_bytes"] < report["steps"][0]["undivided_bytes"]);
    CHECK(report["steps"][4]["strips"] == 1);
  }

  TEST_CASE("one instance, and no lights") {
    Terminal t;
    t.set_up_spheres();
    write_scene(t, R"({"width": 64, "height": 48})", [](nlohmann::json& scene) {
      auto& parts = scene["characters"][0]["parts"];
      parts = nlohmann::json::array({parts[4]});
    });
    CHECK(measure(t)["instances"] == 1);
    write_scene(t, R"({"width": 64, "height": 48})", [](nlohmann::json& scene) { scene.erase("lights"); });
    const auto dark = measure(t);
    CHECK(dark["lights"] == 0);
    CHECK(stages_of(dark["steps"][0]) ==
          std::vector<std::string>{"ray generation", "object intersection", "intersection reduction", "ambient"});
  }

  TEST_CASE("two tables, and whether the films are the same") {
    Terminal t;
    t.set_up_spheres();
    write_scene(t, R"({"width": 32, "height": 32})");
    const std::string out =
        t.succeeds("kdbench", {"paper", "scene.json", "--device", "cpu", "--repeat", "2", "--warm-up", "0"}).out;
    for (const char* text :
         {"the paper's dense form", "reduced hit by hit", "hierarchy", "first occluder", "(ours)",
          "intersection reduction", "shadow, colour", "all, first launch to last", "\nfilm: identical"}) {
      CHECK_MESSAGE(out.find(text) != std::string::npos, text);
    }
  }

  TEST_CASE("errors") {
    Terminal t;
    t.set_up_spheres();
    const auto fails = [&](Arguments arguments, ErrorClass error_class, const std::vector<std::string>& fragments) {
      arguments.insert(arguments.begin(), {"paper", "--device", "cpu"});
      t.fails("kdbench", arguments, error_class, fragments);
    };
    fails({}, ErrorClass::usage, {"scene"});
    fails({"none.json"}, ErrorClass::missing, {"none.json"});
    fails({"spheres.json", "--repeat", "0"}, ErrorClass::usage, {"--repeat"});
    fails({"spheres.json", "--buffers", "0"}, ErrorClass::usage, {"--buffers"});
    fails({"spheres.json", "--json", "spheres.json"}, ErrorClass::usage, {"spheres.json"});
    write_scene(t, R"({"width": 20000, "height": 2})");
    fails({"scene.json", "--buffers", "1"}, ErrorClass::resource, {"5 instances", "2 lights", "--buffers"});
  }
}
