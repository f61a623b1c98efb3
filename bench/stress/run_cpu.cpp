#include <algorithm>
#include <mutex>

#include "stress/run.h"
#include "sys/parallel.h"
#include "sys/timer.h"

namespace kd::stress {

namespace {

constexpr size_t kRayGrain = 32;

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
    for (size_t i = begin; i < end; ++i) {
      const uint64_t index = job.first + i;
      const Query query = make_query(view, job.ray_class, job.seed, index);
      const Verdict verdict = check_query<TestTracer<Test>>(view, query, is_plain(job, index), tally);
      if (peer && verdict.traced && query.excluded == kNoTriangle) peer->trace(verdict, tally);
      if (verdict.fault == Fault::none) continue;
      const std::scoped_lock lock(mutex);
      out.failures.push_back({index, verdict.fault});
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
