// Cancelling while a file is read. Readers call a Watch as they go; who cancelled is thrown through whatever library is
// reading, and `read_file` turns it into an error.
#pragma once

#include <chrono>
#include <cstdint>

#include "sys/progress.h"

namespace kd::mesh {

/// No std::exception, which a library may catch.
struct Cancelled {};

/// Asks a Progress now and then. For one thread.
class Watch {
 public:
  explicit Watch(const Progress& progress) : progress_(progress) {}

  /// To be called at each small step: a line, a face, at most some microseconds of work. Throws Cancelled.
  void step() {
    if (++steps_ % kStepsALook == 0) look();
  }
  /// To be called between steps of some milliseconds.
  void look() {
    const auto now = Clock::now();
    if (now - last_ < kPeriod) return;
    last_ = now;
    if (!keep_going(progress_, 0)) throw Cancelled();
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr uint64_t kStepsALook = 4096;
  static constexpr std::chrono::milliseconds kPeriod{20};

  const Progress& progress_;
  uint64_t steps_ = 0;
  Clock::time_point last_ = Clock::now();
};

}  // namespace kd::mesh
