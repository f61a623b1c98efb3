// kdbench scale, from outside.
#include <doctest/doctest.h>

#include "cli/json_schema.h"
#include "cli/run_tool.h"

using namespace kd;
using namespace kd::test;

namespace {

const nlohmann::json& series_of(const nlohmann::json& report, const std::string& name) {
  for (const auto& series : report["series"]) {
    if (series["name"] == name) return series["rows"];
  }
  FAIL("no series ", name);
  return report;
}

}  // namespace

TEST_SUITE("kdbench scale") {
  TEST_CASE("scenes are what they are said to be, and only what is used is there") {
    const Terminal t;
    const auto report = t.report("kdbench", {"scale", "--quick", "--device", "cpu", "--size", "64x36", "--repeat", "2",
                                             "--warm-up", "0", "--json", "-"});
    check_report("kdbench-scale", report);
    CHECK(report["film"]["width"] == 64);

    const auto& library = series_of(report, "library");
    REQUIRE(library.size() == 2);
    CHECK(library[1]["count"] == 100);
    for (const char* cost : {"instances", "objects_opened", "rays"}) CHECK(library[0][cost] == library[1][cost]);
    CHECK(library[0]["bytes"]["objects"] == library[1]["bytes"]["objects"]);
    CHECK(library[0]["objects_opened"] == 10);

    const auto& folder = series_of(report, "folder");
    for (const auto& row : folder) {
      CHECK(row["bytes"] == folder[0]["bytes"]);
      CHECK(row["rays"] == library[0]["rays"]);
    }

    for (const auto& row : series_of(report, "seen_objects")) {
      CHECK(row["objects_opened"] == row["count"]);
      CHECK(row["instances"] == 10 * row["count"].get<int>());
    }
    const auto& unseen_objects = series_of(report, "unseen_objects");
    for (const char* cost : {"objects_opened", "rays"}) CHECK(unseen_objects[0][cost] == unseen_objects[1][cost]);
    for (const char* bytes : {"objects", "scene"}) {
      CHECK(unseen_objects[0]["bytes"][bytes] == unseen_objects[1]["bytes"][bytes]);
    }

    for (const auto& row : series_of(report, "picture")) {
      CHECK(row["instances"] == row["count"]);
      CHECK(row["rays"]["primary_hits"] > 64 * 36 / 4);
    }
    const auto& unseen = series_of(report, "unseen_instances");
    for (const auto& row : unseen) {
      CHECK(row["instances"] == row["count"].get<int>() + 100);
      CHECK(row["rays"] == unseen[0]["rays"]);
      CHECK(row["bytes"] == [&] {
        auto same = unseen[0]["bytes"];
        same["file"] = row["bytes"]["file"];
        return same;
      }());
    }

    for (const auto& row : series_of(report, "lights_lit")) {
      const uint64_t hits = row["rays"]["primary_hits"], lights = row["count"], shadow = row["rays"]["shadow"];
      CHECK(2 * shadow >= lights * hits);
      CHECK(shadow <= lights * hits);
    }
    for (const char* name : {"lights_black", "lights_behind"}) {
      for (const auto& row : series_of(report, name))
        CHECK_MESSAGE(row["rays"]["shadow"] <= 2 * row["count"].get<int>(), name);
    }
    for (const auto& row : report["motion"]) CHECK(row["instances"] == 1000);
    CHECK(report["motion"].back()["count"] == 100);
  }

  TEST_CASE("errors") {
    const Terminal t;
    t.fails("kdbench", {"scale", "--device", "none"}, ErrorClass::usage, {"none"});
    t.fails("kdbench", {"scale", "--size", "0x5"}, ErrorClass::usage, {"0x5"});
    t.fails("kdbench", {"scale", "--repeat", "0"}, ErrorClass::usage, {"--repeat"});
    t.fails("kdbench", {"scale", "--json", "gone/r.json"}, ErrorClass::output, {"gone/r.json"});
  }
}
