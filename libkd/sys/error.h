// Errors: what is wrong, where, and what to do about it, in one line. A class tells a caller (and a shell: the tools
// exit with it) which kind of thing failed.
#pragma once

#include <string>
#include <utility>

namespace kd {

/// The numbers are the tools' exit statuses and part of their interface. 1 is left to faults of our own, such as an
/// exception that nothing caught.
enum class ErrorClass {
  usage = 2,         // a flag or an argument that cannot be
  missing = 3,       // an input that does not exist or cannot be read
  mesh = 4,          // a mesh that cannot be parsed or holds no surface
  object = 5,        // a .nkd that is truncated, corrupt or of another version
  scene = 6,         // a scene that cannot be parsed, or places something that cannot be placed
  output = 7,        // an output that cannot be written
  device = 8,        // a device that is not there, or failed
  resource = 9,      // more memory, or a larger file, than can be had
  interrupted = 10,  // cancelled from outside
  differs = 11       // a picture that is further from its reference than it may be
};

struct Error {
  ErrorClass error_class = ErrorClass::usage;
  std::string where;  // a path, "path:line:col" or a flag; may be empty
  std::string what;   // the fault, and what to do, without a final full stop

  std::string line() const { return where.empty() ? what : where + ": " + what; }
};

}  // namespace kd
