#include "build/events.h"

#include <array>

namespace kd::build {

void sort_root_events(EventList& events, int bits) {
  constexpr int kDigit = 9;
  constexpr size_t kValues = size_t{1} << kDigit;
  EventList other(events.size());
  for (int shift = 0; shift < bits; shift += kDigit) {
    const auto digit = [&](Event e) { return static_cast<size_t>(e >> (32 + shift)) % kValues; };
    std::array<size_t, kValues> place{};
    for (Event e : events) ++place[digit(e)];
    size_t begin = 0;
    for (size_t& p : place) {
      const size_t count = p;
      p = begin;
      begin += count;
    }
    for (Event e : events) other[place[digit(e)]++] = e;
    events.swap(other);
  }
}

}  // namespace kd::build
