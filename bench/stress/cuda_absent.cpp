#include "stress/run.h"

namespace kd::stress {

struct CudaCase::State {};

CudaCase::CudaCase(std::unique_ptr<State> state) : state_(std::move(state)) {}
CudaCase::CudaCase(CudaCase&&) noexcept = default;
CudaCase::~CudaCase() = default;

Result<CudaCase> CudaCase::upload(const StressCase&, int) {
  return Error{ErrorClass::device, "", "this build has no CUDA backend (configured with KD_CUDA=OFF, or without nvcc)"};
}
Result<JobResult> CudaCase::run(const Job&) const { return JobResult{}; }

}  // namespace kd::stress
