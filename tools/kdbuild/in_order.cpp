#include "kdbuild/in_order.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace kd::tools {

void in_order(size_t count, size_t at_once, const std::function<void(size_t)>& work,
              const std::function<void(size_t)>& after) {
  std::atomic<size_t> next = 0;
  std::mutex mutex;  // guards the rest
  std::vector<bool> done(count);
  size_t told = 0;
  std::exception_ptr fault;

  const auto run = [&] {
    for (size_t i = next++; i < count; i = next++) {
      try {
        work(i);
        const std::lock_guard lock(mutex);
        done[i] = true;
        while (told < count && done[told] && !fault) after(told++);
      } catch (...) {
        next = count;
        const std::lock_guard lock(mutex);
        if (!fault) fault = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (size_t i = 1; i < std::min(at_once, count); ++i) helpers.emplace_back(run);
    run();
  }
  if (fault) std::rethrow_exception(fault);
}

}  // namespace kd::tools
