// A block's warps without a GPU (libkd/render/cuda/warp.h): each lane runs on a stack of its own until it comes to
// something that it does together with others of its warp, and waits there for them. In which order lanes run in
// between changes from time to time, as nothing may hang on it.
#pragma once

#include <ucontext.h>

#include <bit>
#include <functional>
#include <stdexcept>
#include <vector>

#include "render/cuda/warp.h"

namespace kd::test {

class WarpEmulation {
 public:
  /// `shared`: the block's memory, from which addresses count.
  WarpEmulation(uint32_t warps, const void* shared)
      : shared_(static_cast<const char*>(shared)), lanes_(warps * render::warp::kLanes) {
    instance = this;
  }
  WarpEmulation(const WarpEmulation&) = delete;
  WarpEmulation& operator=(const WarpEmulation&) = delete;
  ~WarpEmulation() { instance = nullptr; }

  /// Runs it on all lanes of all warps to its end. Throws std::logic_error if lanes wait for others that never come.
  void run(std::function<void(uint32_t warp)> lane);

  enum class Together { sync, ballot, any_bits, of_lane, of_lane_below, same };
  /// What the running lane is told once all of its warp's `lanes` have come to the same.
  uint64_t meet(Together what, unsigned lanes, uint64_t value, uint32_t which = 0);
  /// The running lane, in its warp.
  uint32_t lane() const { return static_cast<uint32_t>(running_ % render::warp::kLanes); }
  const char* shared() const { return shared_; }

  static inline WarpEmulation* instance = nullptr;

 private:
  struct Lane {
    ucontext_t context;
    std::vector<char> stack;
    bool ended = false, waits = false;
    Together what = Together::sync;
    unsigned lanes = 0;
    uint64_t value = 0, told = 0;
    uint32_t which = 0;
  };

  static void enter();
  void run_lanes();
  // Of the warp whose lanes begin at `first`.
  bool have_met(size_t first, unsigned lanes, Together what) const;
  void tell(size_t first, unsigned lanes);
  /// Lets some lanes that have met go on; false if none have.
  bool let_go();

  const char* shared_;
  std::function<void(uint32_t)> body_;
  std::vector<Lane> lanes_;
  ucontext_t scheduler_{};
  size_t running_ = 0, turn_ = 0;
};

}  // namespace kd::test

namespace kd::render::warp {

// Of of_lane, the one in use; see the header.
template <class T>
T of_lane(T value, uint32_t from) {
  static_assert(sizeof(T) == sizeof(uint32_t));
  auto& warp = *test::WarpEmulation::instance;
  const auto bits = warp.meet(test::WarpEmulation::Together::of_lane, kAll, std::bit_cast<uint32_t>(value), from);
  return std::bit_cast<T>(static_cast<uint32_t>(bits));
}

}  // namespace kd::render::warp
