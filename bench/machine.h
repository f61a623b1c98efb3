// What a figure was measured on.
#pragma once

#include <string>
#include <thread>

namespace kd::bench {

struct Machine {
  std::string processor;  // its model, as the system calls it
  unsigned cores = std::thread::hardware_concurrency();
  std::string compiler;  // name, version, build type
};

Machine this_machine();

}  // namespace kd::bench
