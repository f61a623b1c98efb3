#include "common/report.h"

#include <cstdio>

#include <fmt/format.h>

#include "sys/atomic_file.h"

namespace kd::tools {

Result<void> write_report(const std::string& path, const Json& report) {
  const std::string text = report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  if (path != "-") return write_file(path, text);
  fmt::print("{}", text);
  return {};
}

}  // namespace kd::tools
