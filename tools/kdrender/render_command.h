// What kdrender does.
#pragma once

#include "kdrender/options.h"
#include "sys/result.h"

namespace kd::tools {

constexpr const char* kKdrender = "kdrender";

Result<void> render_command(const RenderOptions& o);

}  // namespace kd::tools
