// Parallel loops on oneTBB, and how many threads they may use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

namespace kd {

/// While one lives, parallel loops use at most `threads` threads; 0 means all the cores there are.
class ThreadLimit {
 public:
  explicit ThreadLimit(unsigned threads) {
    if (threads > 0) control_.emplace(tbb::global_control::max_allowed_parallelism, threads);
  }

 private:
  std::optional<tbb::global_control> control_;
};

inline unsigned thread_count() {
  return static_cast<unsigned>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

/// body(begin, end) over disjoint pieces of [0, count) of at least `grain` elements, in any order.
template <class Body>
void parallel_ranges(size_t count, size_t grain, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, count, grain),
                    [&](const tbb::blocked_range<size_t>& r) { body(r.begin(), r.end()); });
}

/// One T for each thread that asks for it, by `local()`.
template <class T>
using PerThread = tbb::enumerable_thread_specific<T>;

template <class... Tasks>
void parallel_tasks(const Tasks&... tasks) {
  tbb::parallel_invoke(tasks...);
}

}  // namespace kd
