#include "paper/run.h"

namespace kd::bench::paper {

Result<Run> run_on_cuda(const render::LoadedScene&, const render::RenderSettings&, const Job&, int) {
  return Error{ErrorClass::device, "", "this build has no CUDA backend (configured with KD_CUDA=OFF, or without nvcc)"};
}

}  // namespace kd::bench::paper
