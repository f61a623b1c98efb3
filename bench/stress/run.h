// A stress run: jobs, each so many rays of one class at one case, on a device.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "render/backend.h"
#include "render/trace.h"
#include "stress/check.h"
#include "stress/stress_case.h"

namespace kd::stress {

struct Job {
  RayClass ray_class = RayClass::vertices;
  uint64_t seed = 0;
  uint64_t first = 0;  // of the rays' numbers
  uint64_t rays = 0;
  uint32_t plain_every = 0;  // of so many warps of 32 rays, one whose oracle leaves out no triangle; 0: none
  render::TriangleTest test = render::TriangleTest::exact;
};

/// Whether a ray of a job is one of those.
KD_HD KD_INLINE bool is_plain(const Job& job, uint64_t index) {
  return job.plain_every > 0 && scatter(job.seed + index / 32) % job.plain_every == 0;
}

struct JobResult {
  Tally tally;
  std::vector<Failure> failures;  // the first ones, at most kMostFailures
  double seconds = 0;
};

/// Another tracer that gets the same snapped rays, on the CPU.
class Peer {
 public:
  virtual ~Peer() = default;
  /// Adds what it makes of a traced ray to the tally. Called from many threads.
  virtual void trace(const Verdict& verdict, Tally& tally) const = 0;
};

/// On as many threads as kd::ThreadLimit allows. `peer` may be null.
JobResult run_on_cpu(const StressCase& stress_case, const Job& job, const Peer* peer);

/// A case in the memory of a CUDA device.
class CudaCase {
 public:
  /// ErrorClass::device and ErrorClass::resource; ErrorClass::device in a build without CUDA.
  static Result<CudaCase> upload(const StressCase& stress_case, int device_index);
  CudaCase(CudaCase&&) noexcept;
  ~CudaCase();
  Result<JobResult> run(const Job& job) const;

 private:
  struct State;
  explicit CudaCase(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace kd::stress
