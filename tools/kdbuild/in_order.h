// Independent pieces of work, several at once, told of in order.
#pragma once

#include <cstddef>
#include <functional>

namespace kd::tools {

/// Calls work(i) once for each i in [0, count), at most `at_once` at a time, each on a thread of its own, and after(i)
/// in order of i, never two at once, as soon as work(0) to work(i) are done. The first exception of either ends it,
/// once what is under way is done, and is thrown again.
void in_order(size_t count, size_t at_once, const std::function<void(size_t)>& work,
              const std::function<void(size_t)>& after);

}  // namespace kd::tools
