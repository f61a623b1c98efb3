// Device memory: one allocation, carved into aligned pieces. A carver first adds up what it is asked for, then, once
// the memory is there, hands out the same pieces in the same order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "render/cuda/cuda.h"

namespace kd::render {

class DeviceMemory {
 public:
  DeviceMemory() = default;
  DeviceMemory(const DeviceMemory&) = delete;
  DeviceMemory& operator=(const DeviceMemory&) = delete;
  ~DeviceMemory() { cudaFree(base_); }

  /// What the pieces after it are for, should there be no room for them.
  void section(const char* name) { sections_.emplace_back(name, used_); }

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

  /// Takes what the pieces so far add up to, and starts handing them out anew. Without room for them it forgets them;
  /// ErrorClass::resource then says what each section needs, and what is free.
  Result<void> allocate() {
    const cudaError_t status = cudaMalloc(reinterpret_cast<void**>(&base_), used_ ? used_ : 1);
    Error error;
    if (status != cudaSuccess) {
      cudaGetLastError();
      error = cuda_error(status, "allocating device memory");
      error.what += needs();
    }
    bytes_ = std::exchange(used_, 0);
    sections_.clear();
    if (status != cudaSuccess) return error;
    return {};
  }

  /// Of the allocation.
  size_t bytes() const { return bytes_; }

  /// Gives everything back, after which pieces can be laid out anew.
  void release() {
    cudaFree(std::exchange(base_, nullptr));
    bytes_ = used_ = 0;
  }

 private:
  static std::string mebibytes(size_t bytes) { return std::to_string((bytes + (1 << 20) - 1) >> 20); }
  std::string needs() const {
    std::string text = ": " + mebibytes(used_) + " MiB needed";
    for (size_t i = 0; i < sections_.size(); ++i) {
      const size_t end = i + 1 < sections_.size() ? sections_[i + 1].second : used_;
      text += (i == 0 ? " (" : ", ") + std::string(sections_[i].first) + " " + mebibytes(end - sections_[i].second);
    }
    size_t free = 0, total = 0;
    cudaMemGetInfo(&free, &total);
    return text + (sections_.empty() ? "" : ")") + ", " + mebibytes(free) + " of " + mebibytes(total) + " MiB free";
  }

  std::byte* base_ = nullptr;
  size_t used_ = 0;
  size_t bytes_ = 0;
  std::vector<std::pair<const char*, size_t>> sections_;  // each with where it begins
};

}  // namespace kd::render
