// Progress: how a long operation says how far it is and hears that it should stop.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>

namespace kd {

/// Called now and then, from any thread but never by two at once, with the share done in [0, 1]. Returns false to
/// cancel; the operation then ends with ErrorClass::interrupted and leaves nothing behind.
using Progress = std::function<bool(double share)>;

inline bool keep_going(const Progress& progress, double share) { return !progress || progress(share); }

/// A Progress that many threads may ask. The one that finds it free calls it; once cancelled it stays so.
class SharedProgress {
 public:
  explicit SharedProgress(const Progress& progress) : progress_(progress) {}

  bool keep_going(double share) {
    if (progress_ && !cancelled_) {
      const std::unique_lock lock(mutex_, std::try_to_lock);
      if (lock && !progress_(share)) cancelled_ = true;
    }
    return !cancelled_;
  }
  bool cancelled() const { return cancelled_; }

 private:
  const Progress& progress_;
  std::mutex mutex_;
  std::atomic<bool> cancelled_ = false;
};

}  // namespace kd
