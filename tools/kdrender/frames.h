// Which frames of a film, and what each one's files are called.
#pragma once

#include <string>
#include <vector>

#include "sys/result.h"

namespace kd::tools {

/// "12", "1-240" or "1-240x2", whole numbers, ascending. ErrorClass::usage for anything else.
Result<std::vector<int>> parse_frames(const std::string& text);

/// `pattern` with the last run of # in its file's name replaced by the frame, a sign included as long as the run or
/// longer: "a.####.exr" to "a.0012.exr".
std::string numbered(const std::string& pattern, int frame);

/// Whether the file's name, folders apart, has a #.
bool is_numbered(const std::string& pattern);

}  // namespace kd::tools
