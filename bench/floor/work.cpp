#include "floor/work.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <vector>

#include "render/expand.h"
#include "sys/parallel.h"

namespace kd::bench::floors {

namespace {

constexpr size_t kLanes = 32;

enum class Event : uint8_t { step, leaf, triangle, in_double };

/// A ray's events in their order: the counter that traversal takes, and a cursor for the lockstep.
struct Lane {
  std::vector<Event> events;
  size_t at = 0;
  bool hit = false;

  void node() { events.push_back(Event::step); }
  void leaf() { events.push_back(Event::leaf); }
  void triangle() { events.push_back(Event::triangle); }
  void evaluated_in_double() { events.push_back(Event::in_double); }

  bool done() const { return at == events.size(); }
  bool is_at(Event event) const { return !done() && events[at] == event; }
};

using Warp = std::array<Lane, kLanes>;

/// The lanes that are at `event` go past it; whether there was one.
bool advance(std::span<Lane> lanes, Event event) {
  bool any = false;
  for (Lane& lane : lanes) {
    if (!lane.is_at(event)) continue;
    ++lane.at;
    any = true;
  }
  return any;
}

Work in_lockstep(std::span<Lane> lanes) {
  Work work;
  bool entered = false, hit = false;
  for (const Lane& lane : lanes) {
    entered |= !lane.events.empty();
    hit |= lane.hit;
  }
  ++(entered ? work.setups : work.outside);
  ++(hit ? work.hits : work.misses);
  while (true) {
    while (advance(lanes, Event::step)) ++work.steps;
    if (!advance(lanes, Event::leaf)) return work;
    ++work.leaves;
    while (advance(lanes, Event::triangle)) {
      ++work.triangles;
      work.in_double += advance(lanes, Event::in_double);
    }
  }
}

Work of_one(const Lane& lane) {
  Work work;
  ++(lane.events.empty() ? work.outside : work.setups);
  ++(lane.hit ? work.hits : work.misses);
  for (const Event event : lane.events) {
    work.steps += event == Event::step;
    work.leaves += event == Event::leaf;
    work.triangles += event == Event::triangle;
    work.in_double += event == Event::in_double;
  }
  return work;
}

template <RayMode mode>
void trace_warp(const render::TraceView& view, std::span<const render::RayRecord> rays, Warp& warp, RayWork& work) {
  for (size_t i = 0; i < rays.size(); ++i) {
    Lane& lane = warp[i];
    lane.events.clear();
    lane.at = 0;
    lane.hit = render::trace_ray<mode, ExactTest, TriangleLayout::expanded>(view, rays[i], lane).primitive >= 0;
    work.rays += of_one(lane);
  }
  work.warps += in_lockstep(std::span(warp).first(rays.size()));
}

}  // namespace

Work& Work::operator+=(const Work& w) {
  outside += w.outside;
  setups += w.setups;
  steps += w.steps;
  leaves += w.leaves;
  triangles += w.triangles;
  in_double += w.in_double;
  hits += w.hits;
  misses += w.misses;
  return *this;
}

Cost Work::cost(const KernelCosts& c) const {
  const auto times = [](const Cost& cost, uint64_t count) { return cost * static_cast<double>(count); };
  return times(c.outside, outside) + times(c.setup, setups) + times(c.step, steps) + times(c.leaf, leaves) +
         times(c.triangle, triangles) + times(c.in_double, in_double) + times(c.hit, hits) + times(c.miss, misses);
}

RayWork count_work(const nkd::ObjectFile& object, std::span<const render::RayRecord> rays, RayMode mode) {
  const Lattice& lattice = object.summary().lattice;
  const render::HostObject ready(object.geometry(), TriangleLayout::expanded);
  const render::TraceView view{ready.view(), invert(lattice.frame())};
  RayWork total;
  std::mutex mutex;
  parallel_ranges((rays.size() + kLanes - 1) / kLanes, 64, [&](size_t begin, size_t end) {
    RayWork work;
    Warp warp;
    for (size_t i = begin; i < end; ++i) {
      const auto some = rays.subspan(i * kLanes, std::min(kLanes, rays.size() - i * kLanes));
      if (mode == RayMode::any) {
        trace_warp<RayMode::any>(view, some, warp, work);
      } else {
        trace_warp<RayMode::closest>(view, some, warp, work);
      }
    }
    const std::lock_guard lock(mutex);
    total.rays += work.rays;
    total.warps += work.warps;
  });
  return total;
}

Loads loads_of(const Work& rays) {
  // A node for each step, one to begin with, and one for each leaf but the last: as many as steps and leaves.
  const uint64_t nodes = rays.steps + rays.leaves, references = rays.triangles;
  const uint64_t triangles = rays.triangles + rays.hits;  // that which was hit once more
  return {nodes + references, 3 * triangles, 8 * nodes + 4 * references + sizeof(TriangleVertices) * triangles,
          (rays.hits + rays.misses) * (sizeof(render::RayRecord) + sizeof(render::HitRecord))};
}

}  // namespace kd::bench::floors
