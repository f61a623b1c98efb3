// Dependencies for Make and Ninja: "output: inputs".
#pragma once

#include <string>
#include <vector>

namespace kd::tools {

struct Dependencies {
  std::string output;
  std::vector<std::string> inputs;
};

/// A rule a line. Spaces, #, : and the backslashes before them have a backslash before them, $ is doubled: what GCC
/// writes, and Make and Ninja read alike. Names with line breaks cannot be said in this syntax; their rules are left
/// out.
std::string depfile_text(const std::vector<Dependencies>& rules);

}  // namespace kd::tools
