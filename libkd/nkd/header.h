// The checksum of a .nkd's header: of all its values that are no section.
#pragma once

#include <cstdint>

#include "nkd/schema.h"

namespace kd::nkd {

/// XXH3-64 of the scalars, the sections' sizes and checksums, the names and the provenance, in the schema's order, each
/// as it is stored (numbers little-endian, texts behind their 32-bit lengths). Call on verified objects that have them
/// all.
uint64_t header_checksum(const nkd_schema::Object& object);

}  // namespace kd::nkd
