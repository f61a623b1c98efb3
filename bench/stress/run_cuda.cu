#include <algorithm>

#include "render/cuda/device_memory.h"
#include "stress/run.h"
#include "sys/timer.h"

namespace kd::stress {

namespace {

using render::kBlock;
/// Each thread takes this many rays or more, so that adding up tallies costs little.
constexpr uint64_t kRaysPerThread = 4;
constexpr uint64_t kMostBlocks = 132 * 32;

/// What a launch adds to. Displacements as the bits of doubles that are not negative, whose order is that of integers.
struct DeviceTally {
  unsigned long long counts[kCounts];
  unsigned long long moved_near;
  unsigned long long moved_far;
  unsigned long long failed;
  Failure failures[kMostFailures];
};

__device__ void add_to(DeviceTally& total, const Tally& tally) {
  __shared__ unsigned long long counts[kCounts];
  __shared__ unsigned long long moved[2];
  for (uint32_t i = threadIdx.x; i < kCounts; i += blockDim.x) counts[i] = 0;
  if (threadIdx.x < 2) moved[threadIdx.x] = 0;
  __syncthreads();
  for (uint32_t i = 0; i < kCounts; ++i) {
    if (tally.counts[i] != 0) atomicAdd(&counts[i], static_cast<unsigned long long>(tally.counts[i]));
  }
  atomicMax(&moved[0], static_cast<unsigned long long>(__double_as_longlong(tally.moved_near)));
  atomicMax(&moved[1], static_cast<unsigned long long>(__double_as_longlong(tally.moved_far)));
  __syncthreads();
  for (uint32_t i = threadIdx.x; i < kCounts; i += blockDim.x) {
    if (counts[i] != 0) atomicAdd(&total.counts[i], counts[i]);
  }
  if (threadIdx.x == 0) {
    atomicMax(&total.moved_near, moved[0]);
    atomicMax(&total.moved_far, moved[1]);
  }
}

template <class Test>
__global__ void __launch_bounds__(kBlock) stress_kernel(CaseView view, Job job, DeviceTally* total) {
  Tally tally;
  const uint64_t stride = uint64_t{gridDim.x} * blockDim.x;
  for (uint64_t i = uint64_t{blockIdx.x} * blockDim.x + threadIdx.x; i < job.rays; i += stride) {
    const uint64_t index = job.first + i;
    const Query query = make_query(view, job.ray_class, job.seed, index);
    const Verdict verdict = check_query<TestTracer<Test>>(view, query, is_plain(job, index), tally);
    if (verdict.fault == Fault::none) continue;
    const unsigned long long place = atomicAdd(&total->failed, 1ull);
    if (place < kMostFailures) total->failures[place] = {index, verdict.fault};
  }
  add_to(*total, tally);
}

template <class T>
cudaError_t copy_to(const T* piece, const std::vector<T>& from) {
  if (from.empty()) return cudaSuccess;
  return cudaMemcpy(const_cast<T*>(piece), from.data(), from.size() * sizeof(T), cudaMemcpyHostToDevice);
}

}  // namespace

struct CudaCase::State {
  render::DeviceMemory memory;
  CaseView view;
  DeviceTally* tally = nullptr;

  void lay_out(const StressCase& c) {
    view.object.nodes = memory.piece<Node>(c.tree.nodes.size());
    view.object.references = memory.piece<uint32_t>(c.tree.references.size());
    view.object.triangles = memory.piece<TriangleVertices>(c.expanded.size());
    view.oracle.triangles = memory.piece<OracleTriangle>(c.oracle_triangles.size());
    view.oracle.place = memory.piece<uint32_t>(c.places.size());
    view.oracle.boxes = memory.piece<OracleBox>(c.boxes.size());
    view.vertices = memory.piece<Vec3u>(c.vertices.size());
    view.placements = memory.piece<render::InstanceView>(c.placements.size());
    view.shaded = memory.piece<render::ShadedObjectView>(1);
    tally = memory.piece<DeviceTally>(1);
  }

  Result<void> fill(const StressCase& c) {
    const char* action = "uploading a case";
    KD_CUDA_TRY(copy_to(view.object.nodes, c.tree.nodes), action);
    KD_CUDA_TRY(copy_to(view.object.references, c.tree.references), action);
    KD_CUDA_TRY(copy_to(view.object.triangles, c.expanded), action);
    KD_CUDA_TRY(copy_to(view.oracle.triangles, c.oracle_triangles), action);
    KD_CUDA_TRY(copy_to(view.oracle.place, c.places), action);
    KD_CUDA_TRY(copy_to(view.oracle.boxes, c.boxes), action);
    KD_CUDA_TRY(copy_to(view.vertices, c.vertices), action);
    KD_CUDA_TRY(copy_to(view.placements, c.placements), action);
    render::ShadedObjectView shaded;
    shaded.tree = view.object;
    shaded.step = c.lattice.step();
    KD_CUDA_TRY(copy_to(view.shaded, std::vector{shaded}), action);
    return {};
  }
};

CudaCase::CudaCase(std::unique_ptr<State> state) : state_(std::move(state)) {}
CudaCase::CudaCase(CudaCase&&) noexcept = default;
CudaCase::~CudaCase() = default;

Result<CudaCase> CudaCase::upload(const StressCase& stress_case, int device_index) {
  KD_CUDA_TRY(cudaSetDevice(device_index), "choosing the device");
  auto state = std::make_unique<State>();
  state->view = stress_case.host_view();
  state->lay_out(stress_case);
  if (auto allocated = state->memory.allocate(); !allocated) return allocated.error();
  state->lay_out(stress_case);
  if (auto filled = state->fill(stress_case); !filled) return filled.error();
  return CudaCase(std::move(state));
}

Result<JobResult> CudaCase::run(const Job& job) const {
  const char* action = "tracing";
  Timer timer;
  KD_CUDA_TRY(cudaMemset(state_->tally, 0, sizeof(DeviceTally)), action);
  const uint64_t wanted = (job.rays + kBlock * kRaysPerThread - 1) / (kBlock * kRaysPerThread);
  const auto blocks = static_cast<unsigned>(std::clamp<uint64_t>(wanted, 1, kMostBlocks));
  render::with_test(job.test,
                    [&]<class Test>() { stress_kernel<Test><<<blocks, kBlock>>>(state_->view, job, state_->tally); });
  KD_CUDA_TRY(cudaGetLastError(), action);
  DeviceTally total;
  KD_CUDA_TRY(cudaMemcpy(&total, state_->tally, sizeof(total), cudaMemcpyDeviceToHost), action);

  JobResult out;
  std::copy(std::begin(total.counts), std::end(total.counts), out.tally.counts);
  out.tally.moved_near = std::bit_cast<double>(total.moved_near);
  out.tally.moved_far = std::bit_cast<double>(total.moved_far);
  out.failures.assign(total.failures, total.failures + std::min<uint64_t>(total.failed, kMostFailures));
  out.seconds = timer.seconds();
  return out;
}

}  // namespace kd::stress
