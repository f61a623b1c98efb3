#include "machine.h"

#include <fstream>

namespace kd::bench {

Machine this_machine() {
  Machine machine;
  machine.processor = "unknown processor";
  machine.compiler = KD_COMPILER;
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);) {
    const size_t colon = line.find(": ");
    if (!line.starts_with("model name") || colon == std::string::npos) continue;
    machine.processor = line.substr(colon + 2);
    break;
  }
  return machine;
}

}  // namespace kd::bench
