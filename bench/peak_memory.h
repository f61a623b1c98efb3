// How much memory compiling a mesh takes, measured in a process of its own.
#pragma once

#include <cstdint>
#include <string>

#include "kdbuild/settings.h"

namespace kd::bench {

/// Of a process that does what `kdbuild build` does, from reading the mesh to the object on disk. Bytes of resident
/// memory as Linux counts them: heap, stacks, and pages of mapped files, the source mesh's among them.
struct PeakMemory {
  uint64_t before = 0;  // when the process starts: program, libraries
  uint64_t peak = 0;    // the most it ever had (VmHWM), `before` included

  uint64_t added() const { return peak - before; }
};

/// Forks: call it while the process has one thread. Leaves the object at `output`. Errors as tools::build_object;
/// ErrorClass::resource if the child cannot be had or dies.
Result<PeakMemory> compile_in_child(const std::string& input, const std::string& output,
                                    const tools::CompileSettings& settings, unsigned threads);

}  // namespace kd::bench
