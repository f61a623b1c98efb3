// The part of JSON Schema that schema/*.schema.json use.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace kd::test {

/// What in `value` the schema does not allow, a line each with its JSON pointer. Knows type, required, properties,
/// additionalProperties, items, const, enum and $ref to #/$defs; a schema that says more is itself a fault.
std::vector<std::string> schema_faults(const nlohmann::json& schema, const nlohmann::json& value);

/// schema/NAME.schema.json, parsed; fails the test if it is not there.
nlohmann::json read_schema(const std::string& name);

/// Checks a report against schema/NAME.schema.json.
void check_report(const std::string& name, const nlohmann::json& report);

}  // namespace kd::test
