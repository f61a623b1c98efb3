// The checker of reports finds what it should, so that a report without faults means something.
#include <doctest/doctest.h>

#include "cli/json_schema.h"

using namespace kd::test;
using nlohmann::json;

TEST_SUITE("reports") {
  TEST_CASE("the checker finds every kind of fault") {
    const json schema = json::parse(R"({
      "$defs": {"pair": {"type": "array", "items": {"type": "integer"}}},
      "type": "object", "required": ["version", "pair"], "additionalProperties": false,
      "properties": {"version": {"const": 1}, "pair": {"$ref": "#/$defs/pair"}, "kind": {"enum": ["a", "b"]}}})");
    const auto faults = [&](const char* text) { return schema_faults(schema, json::parse(text)); };
    using Faults = std::vector<std::string>;
    CHECK(faults(R"({"version": 1, "pair": [1, 2], "kind": "a"})") == Faults{});
    CHECK(faults(R"({"version": 2, "pair": []})") == Faults{"/version: is not 1"});
    CHECK(faults(R"({"version": 1})") == Faults{"/: lacks \"pair\""});
    CHECK(faults(R"({"version": 1, "pair": [1, 0.5]})") == Faults{"/pair/1: is no \"integer\""});
    CHECK(faults(R"({"version": 1, "pair": [], "kind": "c"})").size() == 1);
    CHECK(faults(R"({"version": 1, "pair": [], "more": 0})") == Faults{"/: has the undocumented more"});
    CHECK(schema_faults({{"minimum", 0}}, 1).size() == 1);
    const json either = json::parse(R"({"oneOf": [{"type": "integer"}, {"type": "number"}, {"type": "string"}]})");
    CHECK(schema_faults(either, 0.5) == Faults{});
    CHECK(schema_faults(either, 1) == Faults{"/: fits several alternatives"});
    CHECK(schema_faults(either, true) == Faults{"/: is no \"integer\""});
  }

  TEST_CASE("the schemas are of one draft, and closed") {
    for (const char* name : {"kdbuild-stats", "kdrender-stats", "kdbench-trace", "kdbench-build", "kdbench-floor",
                             "kdbench-paper", "kdbench-pareto", "kdbench-stress"}) {
      const json schema = read_schema(name);
      CHECK(schema["$schema"] == "https://json-schema.org/draft/2020-12/schema");
      for (const json& part : schema.value("oneOf", json::array({schema}))) {
        const json& shape =
            part.contains("$ref") ? schema.at(json::json_pointer(part["$ref"].get<std::string>().substr(1))) : part;
        CHECK(shape["additionalProperties"] == false);
        CHECK(shape["properties"]["version"]["const"] == 1);
      }
    }
  }
}
