#include <algorithm>
#include <mutex>

#include "core/packet_traversal.h"
#include "stress/run.h"
#include "sys/parallel.h"
#include "sys/timer.h"

namespace kd::stress {

namespace {

constexpr size_t kRayGrain = 32;

/// The rays of a packet, what the judge said of each, and that traced together they meet what each meets alone.
template <class Test>
class JudgedPacket {
 public:
  void add(const Query& query, const Verdict& verdict) {
    const size_t i = count_++;
    verdicts_[i] = verdict;
    rays_[i] = {query.origin, query.direction, query.t_min, query.t_max};
    query_.excluded[i] = query.excluded;
  }

  /// Calls visit(number of the ray in the packet, verdict) for each.
  template <class Visit>
  void judge(const ObjectView& object, Tally& tally, const Visit& visit) {
    if constexpr (Test::kExact) {
      const RaySet set = first_rays(count_);
      const BasicRay<PacketDoubles> p = packed(rays_, set);
      const RaySet traced = set & snap_ray(p.origin, p.direction, p.t_min, p.t_max, object.bits, query_.rays).rays();
      query_.s_limit = query_.rays.s_max;
      PacketAnswer closest, any;
      traverse<RayMode::closest, Test>(object, query_, traced, closest);
      traverse<RayMode::any, Test>(object, query_, traced, any);
      for_each_ray(set, [&](size_t i) {
        Verdict& v = verdicts_[i];
        const bool is_traced = (traced & set_of(i)) != kNoRays;
        const uint32_t shadow = is_traced ? any.met[i] : kNoTriangle;
        const bool same = is_traced == v.traced && (is_traced ? closest.met[i] : kNoTriangle) == v.closest &&
                          (shadow == kNoTriangle) == (v.any == kNoTriangle) &&
                          (shadow == kNoTriangle || shadow != query_.excluded[i]);
        if (same || v.fault != Fault::none) return;
        v.fault = Fault::packet_off;
        tally.add(kMismatches);
      });
    }
    for (size_t i = 0; i < count_; ++i) visit(i, verdicts_[i]);
  }

 private:
  PerRay<Ray> rays_;
  PacketQuery query_;
  PerRay<Verdict> verdicts_;
  size_t count_ = 0;
};

template <class Test>
JobResult run_test(const StressCase& stress_case, const Job& job, const Peer* peer) {
  const HostCase host(stress_case);
  const CaseView& view = host.view();
  JobResult out;
  PerThread<Tally> tallies;
  std::mutex mutex;
  Timer timer;
  parallel_ranges(job.rays, kRayGrain, [&](size_t begin, size_t end) {
    Tally& tally = tallies.local();
    for (size_t first = begin; first < end; first += kPacketRays) {
      JudgedPacket<Test> packet;
      for (size_t i = first; i < std::min(first + kPacketRays, end); ++i) {
        const uint64_t index = job.first + i;
        const Query query = make_query(view, job.ray_class, job.seed, index);
        const Verdict verdict = check_query<TestTracer<Test>>(view, query, is_plain(job, index), tally);
        if (peer && verdict.traced && query.excluded == kNoTriangle) peer->trace(verdict, tally);
        packet.add(query, verdict);
      }
      packet.judge(view.object, tally, [&](size_t i, const Verdict& verdict) {
        if (verdict.fault == Fault::none) return;
        const std::scoped_lock lock(mutex);
        out.failures.push_back({job.first + first + i, verdict.fault});
      });
    }
  });
  out.seconds = timer.seconds();
  for (const Tally& tally : tallies) out.tally.add(tally);
  const auto by_index = [](const Failure& a, const Failure& b) { return a.index < b.index; };
  std::sort(out.failures.begin(), out.failures.end(), by_index);
  out.failures.resize(std::min<size_t>(out.failures.size(), kMostFailures));
  return out;
}

}  // namespace

JobResult run_on_cpu(const StressCase& stress_case, const Job& job, const Peer* peer) {
  return render::with_test(job.test, [&]<class Test>() { return run_test<Test>(stress_case, job, peer); });
}

}  // namespace kd::stress
