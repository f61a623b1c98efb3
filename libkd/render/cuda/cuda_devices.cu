// Which CUDA devices there are.
#include "render/cuda/cuda.h"
#include "render/cuda/cuda_backend.h"

namespace kd::render {

Result<int> cuda_count() {
  int count = 0;
  if (const cudaError_t status = cudaGetDeviceCount(&count); status != cudaSuccess) {
    cudaGetLastError();
    int driver = 0;  // stays 0 where there is none, which CUDA tells as one that is too old
    cudaDriverGetVersion(&driver);
    const char* why = driver == 0 ? "there is no NVIDIA driver on this machine" : cudaGetErrorString(status);
    return Error{ErrorClass::device, "", std::string("no CUDA device: ") + why};
  }
  return count;
}

Result<std::string> cuda_probe(int index) {
  const auto count = cuda_count();
  if (!count) return count.error();
  if (index >= *count) {
    return Error{ErrorClass::device, "",
                 "no CUDA device " + std::to_string(index) + ": there are " + std::to_string(*count)};
  }
  cudaDeviceProp properties;
  KD_CUDA_TRY(cudaGetDeviceProperties(&properties, index), "reading the device's properties");
  return "CUDA " + std::to_string(index) + ": " + properties.name;
}

}  // namespace kd::render
