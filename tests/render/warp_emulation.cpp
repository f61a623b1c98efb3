#include "warp_emulation.h"

#include <cstring>

namespace kd::test {

using render::warp::kLanes;

void WarpEmulation::enter() {
  WarpEmulation& block = *instance;
  block.body_(static_cast<uint32_t>(block.running_ / kLanes));
  Lane& lane = block.lanes_[block.running_];
  lane.ended = true;
  swapcontext(&lane.context, &block.scheduler_);
}

uint64_t WarpEmulation::meet(Together what, unsigned lanes, uint64_t value, uint32_t which) {
  Lane& lane = lanes_[running_];
  lane.waits = true;
  lane.what = what;
  lane.lanes = lanes;
  lane.value = value;
  lane.which = which;
  swapcontext(&lane.context, &scheduler_);
  return lane.told;
}

void WarpEmulation::run(std::function<void(uint32_t)> lane) {
  constexpr size_t kStack = 1 << 18;
  body_ = std::move(lane);
  for (Lane& l : lanes_) {
    l.stack.resize(kStack);
    l.ended = l.waits = false;
    getcontext(&l.context);
    l.context.uc_stack.ss_sp = l.stack.data();
    l.context.uc_stack.ss_size = l.stack.size();
    makecontext(&l.context, enter, 0);
  }
  do {
    run_lanes();
  } while (let_go());
  for (const Lane& l : lanes_) {
    if (!l.ended) throw std::logic_error("lanes wait for others that never come");
  }
}

void WarpEmulation::run_lanes() {
  turn_ = turn_ * 5 + 7;
  for (size_t i = 0; i < lanes_.size(); ++i) {
    running_ = (turn_ + i) % lanes_.size();
    Lane& lane = lanes_[running_];
    if (!lane.ended && !lane.waits) swapcontext(&scheduler_, &lane.context);
  }
}

bool WarpEmulation::have_met(size_t first, unsigned lanes, Together what) const {
  for (uint32_t i = 0; i < kLanes; ++i) {
    const Lane& lane = lanes_[first + i];
    if ((lanes >> i & 1) != 0 && !(lane.waits && lane.lanes == lanes && lane.what == what)) return false;
  }
  return true;
}

bool WarpEmulation::let_go() {
  for (size_t i = 0; i < lanes_.size(); ++i) {
    const Lane& lane = lanes_[i];
    const size_t first = i / kLanes * kLanes;
    if (!lane.waits || !have_met(first, lane.lanes, lane.what)) continue;
    tell(first, lane.lanes);
    return true;
  }
  return false;
}

void WarpEmulation::tell(size_t first, unsigned lanes) {
  const auto for_each = [&](const auto& visit) {
    for (uint32_t i = 0; i < kLanes; ++i) {
      if ((lanes >> i & 1) != 0) visit(i, lanes_[first + i]);
    }
  };
  unsigned ballot = 0, bits = 0;
  for_each([&](uint32_t i, const Lane& lane) {
    ballot |= static_cast<unsigned>(lane.value != 0) << i;
    bits |= static_cast<unsigned>(lane.value);
  });
  for_each([&](uint32_t i, Lane& lane) {
    unsigned same = 0;
    for_each([&](uint32_t j, const Lane& other) { same |= static_cast<unsigned>(other.value == lane.value) << j; });
    switch (lane.what) {
      case Together::sync:
        break;
      case Together::ballot:
        lane.told = ballot;
        break;
      case Together::any_bits:
        lane.told = bits;
        break;
      case Together::of_lane:
        lane.told = lanes_[first + lane.which].value;
        break;
      case Together::of_lane_below:
        lane.told = i >= lane.which ? lanes_[first + i - lane.which].value : lane.value;
        break;
      case Together::same:
        lane.told = same;
        break;
    }
  });
  for_each([](uint32_t, Lane& lane) { lane.waits = false; });
}

}  // namespace kd::test

namespace kd::render::warp {

using test::WarpEmulation;
using Together = WarpEmulation::Together;

namespace {

WarpEmulation& here() { return *WarpEmulation::instance; }
uint32_t word(uint64_t told) { return static_cast<uint32_t>(told); }

}  // namespace

uint32_t lane() { return here().lane(); }
void sync() { here().meet(Together::sync, kAll, 0); }
unsigned ballot(bool value) { return word(here().meet(Together::ballot, kAll, value)); }
unsigned or_of_all(unsigned bits) { return word(here().meet(Together::any_bits, kAll, bits)); }
uint32_t of_lane_below(uint32_t value, uint32_t distance) {
  return word(here().meet(Together::of_lane_below, kAll, value, distance));
}
unsigned same_among(unsigned lanes, uint32_t value) { return word(here().meet(Together::same, lanes, value)); }
uint32_t add(uint32_t* counter, uint32_t value) {
  const uint32_t before = *counter;
  *counter += value;
  return before;
}
uint32_t shared_address(const void* at) {
  return static_cast<uint32_t>(static_cast<const char*>(at) - here().shared());
}
uint32_t distance(uint32_t address, const void* base) { return address - shared_address(base); }
void load_shared(uint32_t address, float& a, float& b) {
  std::memcpy(&a, here().shared() + address, sizeof a);
  std::memcpy(&b, here().shared() + address + sizeof a, sizeof b);
}
uint32_t count(unsigned lanes) { return static_cast<uint32_t>(std::popcount(lanes)); }
uint32_t nth(unsigned lanes, uint32_t n) {
  for (; n > 0; --n) lanes &= lanes - 1;
  return static_cast<uint32_t>(std::countr_zero(lanes));
}

}  // namespace kd::render::warp
