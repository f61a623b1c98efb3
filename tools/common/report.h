// Reports as JSON.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "sys/result.h"

namespace kd::tools {

/// Keys stay in the order in which they were set.
using Json = nlohmann::ordered_json;

/// Writes a report to a file, atomically, or to stdout if `path` is "-".
Result<void> write_report(const std::string& path, const Json& report);

}  // namespace kd::tools
