#include "cli/json_schema.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

#include <doctest/doctest.h>

#include "support/workshop.h"

namespace kd::test {

namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 14> kKnown{
    "$schema", "$id",      "$defs",      "$ref",  "title", "description",          "enum",
    "type",    "required", "properties", "items", "const", "additionalProperties", "oneOf"};

bool has_type(const json& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "boolean") return value.is_boolean();
  if (type == "integer") return value.is_number_integer();
  return type == "number" && value.is_number();
}

class Checker {
 public:
  explicit Checker(const json& root) : root_(root) {}

  void check(const json& schema, const json& value, const std::string& at) {
    for (const auto& [keyword, unused] : schema.items()) {
      if (std::find(kKnown.begin(), kKnown.end(), keyword) == kKnown.end()) fault(at, "unknown keyword " + keyword);
    }
    if (schema.contains("$ref"))
      check(root_.at(json::json_pointer(schema["$ref"].get<std::string>().substr(1))), value, at);
    if (schema.contains("type") && !has_type(value, schema["type"])) fault(at, "is no " + schema["type"].dump());
    if (schema.contains("const") && value != schema["const"]) fault(at, "is not " + schema["const"].dump());
    if (schema.contains("enum") &&
        std::find(schema["enum"].begin(), schema["enum"].end(), value) == schema["enum"].end())
      fault(at, "is none of " + schema["enum"].dump());
    if (schema.contains("oneOf")) check_one_of(schema["oneOf"], value, at);
    if (value.is_object()) check_object(schema, value, at);
    if (!value.is_array() || !schema.contains("items")) return;
    for (size_t i = 0; i < value.size(); ++i) check(schema["items"], value[i], at + '/' + std::to_string(i));
  }

  std::vector<std::string> faults;

 private:
  void check_object(const json& schema, const json& value, const std::string& at) {
    for (const json& name : schema.value("required", json::array())) {
      if (!value.contains(name)) fault(at, "lacks " + name.dump());
    }
    const json properties = schema.value("properties", json::object());
    for (const auto& [name, member] : value.items()) {
      if (properties.contains(name)) {
        check(properties[name], member, at + '/' + name);
      } else if (!schema.value("additionalProperties", true)) {
        fault(at, "has the undocumented " + name);
      }
    }
  }

  /// The faults of the alternative that has the fewest: the one that was meant.
  void check_one_of(const json& alternatives, const json& value, const std::string& at) {
    size_t matches = 0;
    std::vector<std::string> fewest;
    for (const json& alternative : alternatives) {
      Checker checker(root_);
      checker.check(alternative, value, at);
      if (checker.faults.empty()) ++matches;
      if (fewest.empty() || checker.faults.size() < fewest.size()) fewest = checker.faults;
    }
    if (matches > 1) fault(at, "fits several alternatives");
    if (matches == 0) faults.insert(faults.end(), fewest.begin(), fewest.end());
  }

  void fault(const std::string& at, const std::string& what) {
    faults.push_back((at.empty() ? "/" : at) + ": " + what);
  }

  const json& root_;
};

}  // namespace

std::vector<std::string> schema_faults(const json& schema, const json& value) {
  Checker checker(schema);
  checker.check(schema, value, "");
  return checker.faults;
}

json read_schema(const std::string& name) {
  std::ifstream file(source_root() / "schema" / (name + ".schema.json"));
  REQUIRE_MESSAGE(file, name);
  return json::parse(file);
}

void check_report(const std::string& name, const json& report) {
  for (const std::string& fault : schema_faults(read_schema(name), report)) FAIL_CHECK(name << ' ' << fault);
}

}  // namespace kd::test
