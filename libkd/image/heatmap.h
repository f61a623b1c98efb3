// What rays cost, as a picture.
#pragma once

#include <cstdint>
#include <vector>

#include "image/film.h"

namespace kd::image {

/// 8-bit RGB, from black for no visits over purple, red and orange to pale yellow for `most` and more. `visits`: the
/// AOV of that name; a triangle counts as much as a node. `most` > 0.
std::vector<uint8_t> heatmap(const AovBuffer& visits, uint32_t most);

/// The most visits of any pixel, at least 1.
uint32_t most_visits(const AovBuffer& visits);

}  // namespace kd::image
