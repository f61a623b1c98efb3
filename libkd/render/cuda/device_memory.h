// Device memory: one allocation, carved into aligned pieces. A carver first adds up what it is asked for, then, once
// the memory is there, hands out the same pieces in the same order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include <cuda_runtime.h>

#include "sys/result.h"

namespace kd::render {

/// What CUDA says went wrong, and during what.
inline Error cuda_error(cudaError_t status, const char* action) {
  const bool memory = status == cudaErrorMemoryAllocation;
  return {memory ? ErrorClass::resource : ErrorClass::device, "",
          std::string("CUDA: ") + action + ": " + cudaGetErrorString(status)};
}

class DeviceMemory {
 public:
  DeviceMemory() = default;
  DeviceMemory(const DeviceMemory&) = delete;
  DeviceMemory& operator=(const DeviceMemory&) = delete;
  ~DeviceMemory() { cudaFree(base_); }

  /// Lays out a piece of `count` elements; the pointer is null until `allocate`, and right from then on if the same
  /// pieces are asked for again in the same order.
  template <class T>
  T* piece(size_t count) {
    if (count == 0) return nullptr;
    constexpr size_t kAlignment = 256;
    const size_t at = used_;
    used_ += (count * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
    return base_ ? reinterpret_cast<T*>(base_ + at) : nullptr;
  }

  /// Takes what the pieces so far add up to, and starts handing them out anew.
  Result<void> allocate() {
    size_t free = 0, total = 0;
    cudaMemGetInfo(&free, &total);
    const size_t needed = used_;
    used_ = 0;
    if (const cudaError_t status = cudaMalloc(reinterpret_cast<void**>(&base_), needed ? needed : 1);
        status != cudaSuccess) {
      cudaGetLastError();
      Error error = cuda_error(status, "allocating device memory");
      error.what += ": " + std::to_string(needed >> 20) + " MiB needed, " + std::to_string(free >> 20) + " MiB free";
      return error;
    }
    return {};
  }

 private:
  std::byte* base_ = nullptr;
  size_t used_ = 0;
};

}  // namespace kd::render
