// Events of the plane sweep: where along an axis a triangle's box begins, ends, or lies flat.
//
// One 64-bit key each, plane << 34 | kind << 32 | triangle, so that sorting keys sorts by plane, and at a plane in the
// order the sweep needs: ends, then flat ones, then starts (Wald and Havran 2006, section 4.2). The other order loses
// triangles that lie in a split plane.
#pragma once

#include <cstdint>
#include <vector>

#include "core/box.h"

namespace kd::build {

enum class EventKind : uint8_t { end = 0, flat = 1, start = 2 };

using EventPlace = uint32_t;
using Event = uint64_t;
using EventList = std::vector<Event>;

constexpr EventPlace make_place(uint32_t plane, EventKind kind) { return plane << 2 | static_cast<uint8_t>(kind); }
constexpr Event make_event(uint32_t plane, EventKind kind, uint32_t triangle) {
  return uint64_t{make_place(plane, kind)} << 32 | triangle;
}
constexpr uint32_t plane_of(EventPlace p) { return p >> 2; }
constexpr EventKind kind_of(EventPlace p) { return static_cast<EventKind>(p & 3); }
constexpr uint32_t plane_of(Event e) { return plane_of(static_cast<EventPlace>(e >> 32)); }
constexpr EventKind kind_of(Event e) { return kind_of(static_cast<EventPlace>(e >> 32)); }
constexpr uint32_t triangle_of(Event e) { return static_cast<uint32_t>(e); }
/// The same event of a triangle with another number.
constexpr Event renumbered(Event e, uint32_t triangle) { return (e >> 32) << 32 | triangle; }

inline void append_events(const Box3u& box, int axis, uint32_t triangle, EventList& events) {
  const uint32_t lo = box.lo[axis], hi = box.hi[axis];
  if (lo == hi) {
    events.push_back(make_event(lo, EventKind::flat, triangle));
  } else {
    events.push_back(make_event(lo, EventKind::start, triangle));
    events.push_back(make_event(hi, EventKind::end, triangle));
  }
}

/// Sorts events that stand in ascending order of their triangles, by a radix sort of their places, of `bits` bits.
void sort_root_events(EventList& events, int bits);

}  // namespace kd::build
