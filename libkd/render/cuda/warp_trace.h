// Rays that have nothing to do with their neighbours, as diffuse bounces have not: a warp takes 32 at a time, and each
// of its lanes works for all of them.
//
// Where a lane follows one ray and nothing else (core/traversal.h), such rays leave 8 of 32 lanes at work: rays end
// sooner or later, come to a leaf after fewer or more steps, and leaves have fewer or more triangles. Mending one of
// these spreads widens the other two, so all three are:
//   - lanes whose rays have ended take others, once enough of them are idle to share the work of beginning them
//     (Aila and Laine, "Understanding the Efficiency of Ray Traversal on GPUs", HPG 2009, section 3.3);
//   - a lane that comes to a leaf puts it aside and goes on, up to kAside times, while others have found none yet
//     (ibid., speculative traversal);
//   - the triangles of all leaves put aside are dealt out to the lanes, whosever rays they are for; those that float32
//     cannot reject are queued, and decided in double by as many lanes as possible;
//   - when no rays are left to take, idle lanes take over cells from the stacks of those that still have some, so that
//     several lanes work for one ray.
// So what a ray is tested with is in shared memory, 64 bytes, and a lane's registers hold only its way down the tree.
// Some cells are visited in vain, and in another order. That changes no hit: the answer depends on no order of visits
// (core/traversal.h).
#pragma once

#include <cstddef>

#include "render/cuda/warp.h"
#include "render/trace.h"

namespace kd::render {

using warp::kLanes;

// All chosen by measurement on an H100; changed by half, each loses up to a few percent.
constexpr unsigned kWarpTraceBlocks = 8;  // of 128 threads a multiprocessor: 64 registers a thread
constexpr uint32_t kAside = 2;            // leaves that a lane puts aside
constexpr int kStepsAtOnce = 5;           // between two looks at what the other lanes have found
constexpr int kStragglers = 8;            // lanes without a leaf that the others do not wait for
constexpr uint32_t kEnoughIdle = 12;      // lanes that begin rays together
constexpr int kCellsGiven = 4;            // at most, by a lane at once

/// What the rays of a warp are tested with, a column a ray, and what its lanes hand each other. The three rows of
/// planes lie equally far apart, so that a node's axis finds its row by one multiplication. Eight blocks take 97 KiB of
/// a multiprocessor's memory, so that 100 KiB of it are shared memory and the rest is L1 cache: with 132 bounce rays
/// are 1 % slower, with 164 by 6.
struct WarpRays {
  struct Plane {
    float origin, inverse;  // of the ray, along an axis
  };
  struct Slopes {
    float x, y;
  };
  struct Leaf {
    uint32_t first, count;  // references
  };
  struct Dealt {
    uint32_t ray, reference;  // the leaf's first reference, less the number of its first pair
  };
  struct Undecided {
    uint32_t ray, triangle;
  };

  Plane x[kLanes];
  union {
    Leaf leaves[kAside * kLanes];
    Dealt dealt[kAside * kLanes];
  };
  Plane y[kLanes];
  Slopes slopes[kLanes];
  double nearest[kLanes];  // of the hits so far; the ray's s_max before
  Plane z[kLanes];
  uint32_t best[kLanes];  // the triangle of that hit, or kNoHit; above it the ray's axis and its direction's sign
  float s_min[kLanes];
  Undecided queue[kLanes];
  double t_base[kLanes], t_scale[kLanes];  // as in LatticeRay

  static constexpr int kSignBit = 29, kAxisBit = 30;
  static constexpr uint32_t kNoHit = (1u << kSignBit) - 1;  // objects have fewer triangles
  static constexpr uint32_t kCertain = 1u << 31;            // in Undecided::ray

  KD_WARP void keep(uint32_t column, const LatticeRay& ray) {
    const auto shear = detail::shear_along(ray, ray.axis);
    x[column] = {ray.origin.x, ray.inverse.x};
    y[column] = {ray.origin.y, ray.inverse.y};
    z[column] = {ray.origin.z, ray.inverse.z};
    slopes[column] = {shear.slope_x, shear.slope_y};
    nearest[column] = ray.s_max;
    t_base[column] = ray.t_base;
    t_scale[column] = ray.t_scale;
    s_min[column] = ray.s_min;
    const uint32_t backwards = ray.direction[ray.axis] < 0;
    best[column] = static_cast<uint32_t>(ray.axis) << kAxisBit | backwards << kSignBit | kNoHit;
  }

  KD_WARP ExactTest test(uint32_t column) const {
    const uint32_t kept = best[column], axis = kept >> kAxisBit;
    const Slopes slope = slopes[column];
    const Vec3f origin{x[column].origin, y[column].origin, z[column].origin};
    return {{origin, slope.x, slope.y, axis == 0, axis == 1}, (kept >> kSignBit & 1) != 0 ? -1.0f : 1.0f};
  }

  KD_WARP uint32_t hit(uint32_t column) const { return best[column] & kNoHit; }

  /// Makes it the hit if it is nearer, or as near and of the lower index. One lane at a time for each ray.
  KD_WARP void meet(uint32_t column, uint32_t triangle, double s) {
    const uint32_t kept = best[column];
    if (s > nearest[column] || (s == nearest[column] && triangle > (kept & kNoHit))) return;
    nearest[column] = s;
    best[column] = (kept & ~kNoHit) | triangle;
  }
};
static_assert(offsetof(WarpRays, z) == 2 * offsetof(WarpRays, y));
static_assert(kWarpTraceBlocks * (4 * sizeof(WarpRays) + 128 + 1024) <= 100 * 1024);

/// One warp's work. Every function but those of a single ray is for all of its lanes at once.
template <RayMode mode, TriangleLayout layout>
class WarpTrace {
 public:
  /// `stack`: kMaxDepth entries of the lane's own. `none_left`: no ray is left to take, as one of the block's warps has
  /// seen; false before.
  KD_WARP WarpTrace(const TraceView& view, WarpRays& rays, detail::StackEntry* stack, volatile bool& none_left)
      : view_(view), rays_(rays), stack_(stack), none_left_(none_left) {
    take_column(warp::lane());
  }

  /// Traces rays until there are none, taking them by adding to *taken, which all warps share.
  KD_WARP void run(const RayRecord* records, uint32_t count, uint32_t* taken, HitRecord* hits) {
    record_ = count;
    for (bool more = true; more;) {
      const unsigned idle = warp::ballot(!has_cell());
      const uint32_t wanted = warp::count(idle);
      if (wanted < kEnoughIdle) {
        find_leaves(~idle);
        test_leaves();
        more = warp::ballot(none_left_) == 0;
        continue;
      }
      if (!has_cell() && record_ < count) finish(records, hits);
      uint32_t first = 0;
      if (warp::lane() == 0) first = warp::add(taken, wanted);
      first = warp::of_lane(first, 0);
      more = first + wanted < count;
      if (!more) none_left_ = true;
      if (!has_cell()) {
        record_ = first + warp::count(idle & warp::before());
        if (record_ < count) begin(load(records + record_));
      }
      warp::sync();
    }
    while (warp::ballot(has_cell()) != 0) {
      share_stacks();
      find_leaves(warp::ballot(has_cell()));
      test_leaves();
    }
    if (record_ < count) finish(records, hits);
  }

 private:
  KD_WARP void take_column(uint32_t column) { planes_ = warp::shared_address(&rays_.x[column]); }

  /// The column of the ray that the lane works for.
  KD_WARP uint32_t column() const {
    return warp::distance(planes_, rays_.x) / static_cast<uint32_t>(sizeof(WarpRays::Plane));
  }

  /// Without one, a lane stands at a leaf that no tree has, and its stack is empty.
  KD_WARP bool has_cell() const { return node_.link != kNowhere.link; }
  KD_WARP void leave_cells() {
    node_ = kNowhere;
    depth_ = 0;
  }

  /// Idle lanes take over cells that others have on top of their stacks.
  KD_WARP void share_stacks() {
    for (int i = 0; i < kCellsGiven; ++i) {
      const unsigned idle = warp::ballot(!has_cell()), givers = warp::ballot(has_cell() && depth_ > 0);
      const uint32_t shared = min_of(warp::count(givers), warp::count(idle));
      if (shared == 0) return;
      const uint32_t rank = warp::count((has_cell() ? givers : idle) & warp::before());
      const bool gives = has_cell() && depth_ > 0 && rank < shared, takes = !has_cell() && rank < shared;
      detail::StackEntry cell{};
      const float begins = way_.s_resume;
      if (gives) {
        --depth_;
        cell = stack_[depth_];
        way_.s_resume = cell.s_exit;
      }
      const uint32_t giver = takes ? warp::nth(givers, rank) : warp::lane();
      const uint32_t node = warp::of_lane(cell.node, giver), theirs = warp::of_lane(column(), giver);
      const float s_exit = warp::of_lane(cell.s_exit, giver), s_entry = warp::of_lane(begins, giver);
      if (!takes) continue;
      take_column(theirs);
      s_best_ = rounded_up(rays_.nearest[theirs]);
      way_ = {s_entry * detail::kResumeMargin, s_exit, s_exit};
      if (s_best_ >= way_.s_entry) node_ = load(view_.object.nodes + node);
    }
  }

  KD_WARP void begin(const RayRecord& r) {
    take_column(warp::lane());
    LatticeRay ray;
    const bool enters = lattice_ray<true>(view_.to_lattice, view_.object.bits, r, ray);
    rays_.best[warp::lane()] = WarpRays::kNoHit;
    if (!enters) return;
    rays_.keep(warp::lane(), ray);
    s_best_ = ray.s_max;
    const float s_out = min_of(ray.s_exit, ray.s_max) * detail::kMargin;
    way_ = {ray.s_min, s_out, s_out};
    node_ = load(view_.object.nodes);
  }

  KD_WARP void finish(const RayRecord* records, HitRecord* hits) const {
    const uint32_t triangle = rays_.hit(warp::lane());
    if (triangle == WarpRays::kNoHit) {
      hits[record_] = miss_of(load(records + record_));
      return;
    }
    LatticeRay ray;
    ray.t_base = rays_.t_base[warp::lane()];
    ray.t_scale = rays_.t_scale[warp::lane()];
    const TriangleHit hit = rays_.test(warp::lane()).locate(view_.object.triangle<layout>(triangle));
    hits[record_] = record_of(view_, ray, triangle, hit);
  }

  /// Goes on until all but a few of the `live` lanes have put a leaf aside or come to an end.
  KD_WARP void find_leaves(unsigned live) {
    aside_ = 0;
    unsigned without;
    do {
      KD_UNROLL
      for (int i = 0; i < kStepsAtOnce; ++i) {
        if (is_leaf(node_)) break;
        step();
      }
      const uint32_t references = reference_count(node_);
      // An empty leaf is passed even where there is no room for others. It may stand for no cell, but for a ray that
      // meets neither child; and then its entry, which test_leaves asks for, may lie behind its exit.
      if (is_leaf(node_) && (references == 0 || aside_ < kAside)) {
        if (references != 0) {
          rays_.leaves[aside_ * kLanes + warp::lane()] = {first_reference(node_), references};
          ++aside_;
        }
        take_from_stack();
      }
      without = warp::ballot(has_cell() && aside_ == 0);
    } while (warp::count(without) > kStragglers || without == live);
  }

  KD_WARP void step() {
    const WarpRays::Plane plane = plane_along(split_axis(node_));
    const uint32_t next = detail::step_down(node_, plane.origin, plane.inverse, way_, [&](uint32_t far) {
      stack_[depth_] = {far, way_.s_exit};
      ++depth_;
    });
    node_ = load(view_.object.nodes + next);
  }

  KD_WARP WarpRays::Plane plane_along(int axis) const {
    WarpRays::Plane plane;
    warp::load_shared(planes_ + static_cast<uint32_t>(axis) * static_cast<uint32_t>(offsetof(WarpRays, y)),
                      plane.origin, plane.inverse);
    return plane;
  }

  KD_WARP void take_from_stack() {
    way_.s_entry = way_.s_resume * detail::kResumeMargin;
    if (depth_ == 0 || s_best_ < way_.s_entry) {
      leave_cells();
      return;
    }
    --depth_;
    way_.s_resume = way_.s_exit = stack_[depth_].s_exit;
    node_ = load(view_.object.nodes + stack_[depth_].node);
  }

  /// Tests the triangles of the leaves put aside, and ends the rays that need not go on.
  KD_WARP void test_leaves() {
    warp::sync();
    const unsigned have_a = warp::ballot(aside_ > 0), have_b = warp::ballot(aside_ > 1);
    static_assert(kAside == 2);
    const WarpRays::Leaf a = rays_.leaves[warp::lane()], b = rays_.leaves[kLanes + warp::lane()];
    const uint32_t in_a = aside_ > 0 ? a.count : 0, in_b = aside_ > 1 ? b.count : 0;

    // Pairs of a ray and a triangle, numbered from lane to lane.
    uint32_t end = in_a + in_b;
    KD_UNROLL
    for (uint32_t distance = 1; distance < kLanes; distance *= 2) {
      const uint32_t lower = warp::of_lane_below(end, distance);
      if (warp::lane() >= distance) end += lower;
    }
    const uint32_t pairs = warp::of_lane(end, kLanes - 1), pair_b = end - in_b, pair_a = pair_b - in_a;
    const uint32_t at = warp::count(have_a & warp::before()) + warp::count(have_b & warp::before());
    warp::sync();
    if (aside_ > 0) rays_.dealt[at] = {column(), a.first - pair_a};
    if (aside_ > 1) rays_.dealt[at + 1] = {column(), b.first - pair_b};
    warp::sync();

    uint32_t leaves = 0, queued = 0;
    for (uint32_t base = 0;; base += kLanes) {
      WarpRays::Undecided pair{};
      bool undecided = false;
      if (base < pairs) {
        // Which of these pairs begin a leaf, a bit each.
        const auto begins = [&](uint32_t first, uint32_t in) {
          return in != 0 && first - base < kLanes ? 1u << (first - base) : 0;
        };
        const unsigned beginning = warp::or_of_all(begins(pair_a, in_a) | begins(pair_b, in_b));
        if (base + warp::lane() < pairs) {
          const WarpRays::Dealt leaf = rays_.dealt[leaves + warp::count(beginning & (warp::before() * 2 + 1)) - 1];
          pair = {leaf.ray, view_.object.references[leaf.reference + base + warp::lane()]};
          const auto decision = rays_.test(pair.ray).filter(view_.object.triangle<layout>(pair.triangle));
          undecided = !(decision.certain && decision.apart);
          if (decision.certain) pair.ray |= WarpRays::kCertain;
        }
        leaves += warp::count(beginning);
      }
      const unsigned left = warp::ballot(undecided);
      if (base >= pairs || queued + warp::count(left) > kLanes) {
        decide(queued);
        queued = 0;
      }
      if (base >= pairs) break;
      if (undecided) rays_.queue[queued + warp::count(left & warp::before())] = pair;
      queued += warp::count(left);
    }

    if constexpr (mode == RayMode::any) {
      if (rays_.hit(column()) != WarpRays::kNoHit) leave_cells();
    } else {
      s_best_ = rounded_up(rays_.nearest[column()]);
      if (s_best_ < way_.s_entry * detail::kResumeMargin) leave_cells();
    }
  }

  /// Decides what is in the queue, in double.
  KD_WARP void decide(uint32_t queued) {
    warp::sync();
    bool hit = false;
    double s = 0;
    uint32_t ray = 0, triangle = 0;
    if (warp::lane() < queued) {
      const WarpRays::Undecided pair = rays_.queue[warp::lane()];
      ray = pair.ray % kLanes;
      triangle = pair.triangle;
      hit = rays_.test(ray).template meets_in_double<mode>(view_.object.triangle<layout>(triangle),
                                                           (pair.ray & WarpRays::kCertain) != 0, s) &&
            s >= rays_.s_min[ray] && s <= rays_.nearest[ray];
    }
    // Of several lanes with hits of one ray, one after the other.
    for (unsigned hits; (hits = warp::ballot(hit)) != 0; warp::sync()) {
      if (!hit) continue;
      const unsigned same = warp::same_among(hits, ray);
      if ((same & warp::before()) != 0) continue;
      rays_.meet(ray, triangle, s);
      hit = false;
    }
  }

  static constexpr Node kNowhere{0, 5};  // empty, and not an empty leaf of a tree, whose link is 4

  const TraceView& view_;
  WarpRays& rays_;
  detail::StackEntry* stack_;
  volatile bool& none_left_;
  uint32_t planes_;  // of this lane's ray, in shared memory

  uint32_t record_;  // which ray its column has; none if there are no more
  Node node_ = kNowhere;
  detail::Way way_;  // without a cell: anything
  float s_best_;     // the same
  int depth_ = 0;
  uint32_t aside_;  // leaves put aside
};

}  // namespace kd::render
