// One ray, traced by the product, or with a triangle test in place of its own, and judged by the oracle; one
// implementation for every device.
//
// What is demanded of a ray, beyond what its class demands (rays.h):
//   - that it passes through the cube is not overlooked; it moves no further than core/lattice_ray.h allows;
//   - of the triangles that it may touch, the triangle test meets those that the exact ray crosses and no other, with
//     distance and weights to kRoundings roundings;
//   - the nearest hit is the nearest crossing, and a shadow ray meets something exactly where there is a crossing, with
//     the nearest triangle excluded, too. Where the roundings of two distances in double overlap, either may be the
//     nearer.
#pragma once

#include "core/traversal.h"
#include "stress/exact.h"
#include "stress/rays.h"
#include "stress/tally.h"

namespace kd::stress {

/// What is under test: the traversal, with a triangle test. Every test gets the ray as snapped, which float32 holds
/// exactly, so that each is judged on the very ray that it was given.
template <class Test>
struct TestTracer {
  static constexpr bool kExact = Test::kExact;

  template <class Counter>
  KD_HD static uint32_t closest(const CaseView& c, const LatticeRay& ray, uint32_t excluded, Counter& counter) {
    return traverse<RayMode::closest, Test>(c.object, ray, ray.s_max, excluded, counter);
  }
  KD_HD static uint32_t any(const CaseView& c, const LatticeRay& ray, uint32_t excluded) {
    NoCounter counter;
    return traverse<RayMode::any, Test>(c.object, ray, ray.s_max, excluded, counter);
  }
  KD_HD static bool meets(const CaseView& c, const LatticeRay& ray, uint32_t triangle, TriangleHit& hit) {
    const Test test{ray};
    NoCounter counter;
    typename Test::Distance s;
    if (!test.template meets<RayMode::any>(c.object.triangles[triangle], kAnyDistance, s, counter)) return false;
    const auto found = test.locate(c.object.triangles[triangle]);
    hit = {found.s, found.u, found.v};
    return true;
  }

 private:
  static constexpr float kAnyDistance = 1e30f;
};

/// The product.
using ProductTracer = TestTracer<ExactTest>;

/// Of a hit's distance, in roundings of the farthest vertex's, and of its weights, in roundings of 1. The product's
/// bound is 8 (tests/core/test_triangle.cpp); the oracle's own divisions add up to 4.
constexpr double kRoundings = 12;

/// The unit roundoff of a tracer's distances. Those of the float32 tests have no bound and are not judged; but where
/// so many roundings cannot tell which of two triangles is the nearer, they may take either.
template <class Tracer>
constexpr double kRoundoff = Tracer::kExact ? 0x1p-53 : 0x1p-24;

/// How far a snapped ray may lie from the true one, in grid steps an axis (core/lattice_ray.h): half a step where it
/// starts, one where it leaves. At 24 bits a ray that enters the cube through a face along its axis starts up to half
/// a step further off.
KD_HD KD_INLINE double allowed_near(int bits) { return bits < kMaxLatticeBits ? 0.5 : 1; }
KD_HD KD_INLINE double allowed_far(int bits) { return bits < kMaxLatticeBits ? 1 : 1.5; }

/// What the oracle says of a ray.
struct Verdict {
  LatticeRay ray;
  bool traced = false;    // the ray has a point in the cube
  bool meets = false;     // there certainly is a hit
  bool may_meet = false;  // there may be one: false is certain
  Fault fault = Fault::none;
  uint32_t closest = kNoTriangle;  // what the tracer found
  uint32_t any = kNoTriangle;
};

namespace detail {

struct TestCounter {
  uint64_t tests = 0;
  uint64_t in_double = 0;
  KD_HD KD_INLINE void node() {}
  KD_HD KD_INLINE void leaf() {}
  KD_HD KD_INLINE void triangle() { ++tests; }
  KD_HD KD_INLINE void evaluated_in_double() { ++in_double; }
};

/// A hit, and the distances between which the product may put it: where the ray passes through an edge or a vertex, the
/// farther ones too that order faces there.
struct Rank {
  double s_least = 2e30, s_most = 2e30;
  uint32_t triangle = kNoTriangle;

  /// Certainly.
  KD_HD KD_INLINE bool before(const Rank& other) const { return s_most < other.s_least; }
  KD_HD KD_INLINE bool certainly_within(const LatticeRay& ray) const {
    return s_least >= ray.s_min && s_most <= ray.s_max;
  }
  KD_HD KD_INLINE bool maybe_within(const LatticeRay& ray) const { return s_most >= ray.s_min && s_least <= ray.s_max; }
};

template <class Tracer>
KD_HD KD_INLINE Rank rank_of(const Crossing& crossing, uint32_t triangle) {
  const double slack = kRoundings * kRoundoff<Tracer> * crossing.farthest;
  const double later = crossing.touches ? 0x1p-46 * (3 * crossing.farthest + 1) : 0;
  return {crossing.s - slack, crossing.s + slack + later, triangle};
}

/// All that the oracle gathers of one ray's crossings.
struct Survey {
  Rank first, second;  // of what certainly counts: the first, and the first but for the product's own answer
  bool possible = false;
  bool ambiguous = false;  // a crossing may or may not count
  bool ties = false;
  uint64_t decided = 0;
  uint64_t met = 0;  // by the triangle test under test, counting ones
  Fault fault = Fault::none;
};

template <class Tracer>
KD_HD Fault judge_test(const Crossing& exact, bool met, const TriangleHit& hit) {
  if (!exact.met) return met ? Fault::test_doubled : Fault::none;
  if (!met) return exact.behind ? Fault::none : Fault::test_missed;  // what lies behind the ray may be left out
  if (!Tracer::kExact) return Fault::none;
  const double slack = kRoundings * kRoundoff<Tracer>;
  const bool good = std::fabs(hit.s - exact.s) <= slack * exact.farthest && std::fabs(hit.u - exact.v) <= slack &&
                    std::fabs(hit.v - exact.w) <= slack;
  return good ? Fault::none : Fault::test_off;
}

/// Whether the line passes through the cube, within [t_min, t_max], for more than rounding and snapping may take off
/// it.
KD_HD inline bool certainly_enters(const CaseView& c, const Query& q) {
  const double top = c.top(), grid = 1.0 / static_cast<double>(1u << (kMaxLatticeBits - c.object.bits));
  const double size = max_of(std::fabs(q.origin.x), std::fabs(q.origin.y), std::fabs(q.origin.z)) + top;
  const double inset = 2 * grid + 0x1p-48 * size;
  double enter = q.t_min, leave = q.t_max;
  for (int axis = 0; axis < 3; ++axis) {
    const double o = q.origin[axis], d = q.direction[axis];
    if (d == 0) {
      if (!(o > inset && o < top - inset)) return false;
      continue;
    }
    const double t0 = (inset - o) / d, t1 = (top - inset - o) / d;
    enter = max_of(enter, min_of(t0, t1));
    leave = min_of(leave, max_of(t0, t1));
  }
  return enter + (std::fabs(enter) + std::fabs(leave)) * 0x1p-48 < leave;
}

/// How far the snapped ray lies from the true one at distance s, in grid steps, but for what double costs; -1 where the
/// true one is outside the cube.
KD_HD inline double displacement(const CaseView& c, const Query& q, const LatticeRay& ray, double s) {
  const double top = c.top(), grid = 1.0 / static_cast<double>(1u << (kMaxLatticeBits - c.object.bits));
  const double size = max_of(std::fabs(q.origin.x), std::fabs(q.origin.y), std::fabs(q.origin.z)) + top;
  const double rounding = 8 * size * 0x1p-52;
  const int k = ray.axis;
  const double t =
      (static_cast<double>(ray.origin[k]) + s * static_cast<double>(ray.direction[k]) - q.origin[k]) / q.direction[k];
  double moved = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double p = q.origin[axis] + t * q.direction[axis];
    if (!(p >= 0 && p <= top)) return -1;
    const double snapped = static_cast<double>(ray.origin[axis]) + s * static_cast<double>(ray.direction[axis]);
    moved = max_of(moved, std::fabs(p - snapped) - rounding);
  }
  return moved / grid;
}

KD_HD inline Fault judge_displacement(const CaseView& c, const Query& q, const LatticeRay& ray, Tally& tally) {
  const double top = c.top();
  const double origin = ray.origin[ray.axis], far = ray.direction[ray.axis] > 0 ? top - origin : origin;
  const double near_end = displacement(c, q, ray, 0);
  if (near_end < 0) return Fault::none;  // it enters the cube further on
  const double far_end = displacement(c, q, ray, far);
  tally.moved_near = max_of(tally.moved_near, near_end);
  tally.moved_far = max_of(tally.moved_far, far_end);
  const bool within = near_end <= allowed_near(c.object.bits) && far_end <= allowed_far(c.object.bits);
  return within ? Fault::none : Fault::displaced;
}

/// Looks at every triangle that the ray may touch. `answer`: the product's, for Survey::second.
template <class Tracer>
KD_HD Survey survey(const CaseView& c, const LatticeRay& ray, const ExactRay& exact, uint32_t excluded, uint32_t answer,
                    bool plainly) {
  Survey out;
  for_each_touched(c.oracle, exact, plainly, [&](const OracleTriangle& triangle) {
    const Crossing crossing = cross_triangle(exact, triangle);
    TriangleHit hit{};
    const bool met = Tracer::meets(c, ray, triangle.index, hit);
    ++out.decided;
    if (out.fault == Fault::none) out.fault = judge_test<Tracer>(crossing, met, hit);
    if (!crossing.met || triangle.index == excluded) return;
    const Rank rank = rank_of<Tracer>(crossing, triangle.index);
    if (!rank.maybe_within(ray)) return;
    out.possible = true;
    out.ties = out.ties || crossing.touches;
    out.met += met;
    if (!rank.certainly_within(ray)) {
      out.ambiguous = true;
      return;
    }
    if (rank.s_most < out.first.s_most) out.first = rank;
    if (triangle.index != answer && rank.s_most < out.second.s_most) out.second = rank;
  });
  return out;
}

/// Whether the ray crosses the triangle where it counts, and at which distance at the least.
template <class Tracer>
KD_HD bool may_be_met(const CaseView& c, const LatticeRay& ray, const ExactRay& exact, uint32_t triangle, Rank& rank) {
  const Crossing crossing = cross_triangle(exact, c.oracle.triangle(triangle));
  if (!crossing.met) return false;
  rank = rank_of<Tracer>(crossing, triangle);
  return rank.maybe_within(ray);
}

/// The answers of traversal to one ray.
struct Answers {
  uint32_t closest = kNoTriangle;
  uint32_t any = kNoTriangle;
  uint32_t any_other = kNoTriangle;  // but for `closest`
};

template <class Tracer>
KD_HD Fault judge_answers(const CaseView& c, const LatticeRay& ray, const ExactRay& exact, uint32_t excluded,
                          const Survey& s, const Answers& a) {
  Rank rank;
  if (a.closest == kNoTriangle) {
    if (s.first.triangle != kNoTriangle) return Fault::closest_none;
  } else {
    if (a.closest == excluded || !may_be_met<Tracer>(c, ray, exact, a.closest, rank)) return Fault::closest_off;
    if (s.first.before(rank)) return Fault::closest_far;
  }
  if (a.any == kNoTriangle) {
    if (s.first.triangle != kNoTriangle) return Fault::any_none;
  } else if (a.any == excluded || !may_be_met<Tracer>(c, ray, exact, a.any, rank)) {
    return Fault::any_off;
  }
  if (excluded != kNoTriangle || a.closest == kNoTriangle) return Fault::none;
  if (a.any_other == kNoTriangle) return s.second.triangle != kNoTriangle ? Fault::any_none : Fault::none;
  return a.any_other == a.closest || !may_be_met<Tracer>(c, ray, exact, a.any_other, rank) ? Fault::any_off
                                                                                           : Fault::none;
}

KD_HD inline Fault judge_demand(const CaseView& c, const Query& q, const Survey& s, const Answers& a) {
  switch (q.demand) {
    case Demand::hit:
      return a.closest == kNoTriangle || a.any == kNoTriangle ? Fault::leak : Fault::none;
    case Demand::even:
      return s.met % 2 != 0 && !s.ambiguous ? Fault::odd : Fault::none;
    case Demand::lit:
      return a.any != kNoTriangle ? Fault::acne : Fault::none;
    case Demand::occluded:
      return a.any == kNoTriangle ? Fault::contact_lost : Fault::none;
    case Demand::lifted:
      return a.any != kNoTriangle && coplanar(c.oracle.triangle(q.excluded), c.oracle.triangle(a.any)) ? Fault::acne
                                                                                                       : Fault::none;
    default:
      return Fault::none;
  }
}

template <class Tracer>
KD_HD Fault check_traced(const CaseView& c, const Query& q, bool plainly, Verdict& verdict, Tally& tally) {
  const LatticeRay& ray = verdict.ray;
  ExactRay exact;
  if (!to_integers(ray, c.object.bits, exact)) return Fault::off_grid;
  const Fault displaced = judge_displacement(c, q, ray, tally);

  Answers answers;
  TestCounter counter;
  answers.closest = Tracer::closest(c, ray, q.excluded, counter);
  answers.any = Tracer::any(c, ray, q.excluded);
  if (q.excluded == kNoTriangle && answers.closest != kNoTriangle)
    answers.any_other = Tracer::any(c, ray, answers.closest);
  const Survey s = survey<Tracer>(c, ray, exact, q.excluded, answers.closest, plainly);

  verdict.closest = answers.closest;
  verdict.any = answers.any;
  verdict.meets = s.first.triangle != kNoTriangle;
  verdict.may_meet = s.possible;
  tally.add(kSnapped);
  tally.add(kPlain, plainly);
  tally.add(kHits, verdict.meets);
  tally.add(kTies, s.ties);
  tally.add(kTriangleTests, counter.tests);
  tally.add(kDoubleTests, counter.in_double);
  tally.add(kExactTests, s.decided);
  if (displaced != Fault::none) return displaced;
  if (s.fault != Fault::none) return s.fault;
  if (const Fault fault = judge_demand(c, q, s, answers); fault != Fault::none) return fault;
  return judge_answers<Tracer>(c, ray, exact, q.excluded, s, answers);
}

}  // namespace detail

/// Traces one ray and counts what is wrong with it. `plainly`: the oracle leaves out no triangle.
template <class Tracer = ProductTracer>
KD_HD Verdict check_query(const CaseView& c, const Query& q, bool plainly, Tally& tally) {
  Verdict verdict;
  tally.add(kRays);
  verdict.traced = snap_ray(q.origin, q.direction, q.t_min, q.t_max, c.object.bits, verdict.ray);
  if (verdict.traced) {
    verdict.fault = detail::check_traced<Tracer>(c, q, plainly, verdict, tally);
  } else if (q.demand == Demand::hit) {
    verdict.fault = Fault::leak;
  } else if (detail::certainly_enters(c, q)) {
    verdict.fault = Fault::unsnapped;
  }
  const Harm harm = harm_of(verdict.fault);
  tally.add(kMisses, harm == Harm::miss);
  tally.add(kDoubleCounts, harm == Harm::double_count);
  tally.add(kMismatches, harm == Harm::mismatch);
  return verdict;
}

}  // namespace kd::stress
