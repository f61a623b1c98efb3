// data: URIs (RFC 2397) that hold bytes in base64.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "mesh/watch.h"

namespace kd::mesh {

/// The bytes of `uri`, of any media type; nothing if it has none, or is not in base64 (RFC 4648, section 4, padded or
/// not). Throws Cancelled.
std::optional<std::vector<std::byte>> decode_data_uri(std::string_view uri, Watch& watch);

}  // namespace kd::mesh
