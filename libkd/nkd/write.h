// Writing .nkd files.
#pragma once

#include <string>

#include "nkd/contents.h"
#include "sys/result.h"

namespace kd::nkd {

/// Writes an object, whole or not at all; returns the file's size in bytes. The same contents give the same bytes.
/// ErrorClass::output if the file cannot be written, ErrorClass::resource if it would pass the 2 GiB of a FlatBuffer.
Result<uint64_t> write_object(const std::string& path, const Summary& summary, const Geometry& geometry,
                              const Attributes& attributes);

}  // namespace kd::nkd
