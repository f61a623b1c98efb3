// Memory for a large array that is about to be written whole: not cleared first, and on huge pages where the system has
// them, so that the first touch costs a page fault every 2 MiB and not every 4 KiB.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <span>
#include <type_traits>

#include <sys/mman.h>

namespace kd {

template <class T>
class HugeArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  HugeArray() = default;
  /// Throws std::bad_alloc.
  explicit HugeArray(size_t count) : size_(count) {
    // What does not fill a huge page takes what it needs: a scene may have thousands of small objects.
    const size_t alignment = count * sizeof(T) < kHugePage ? kCacheLine : kHugePage;
    const size_t bytes = (count * sizeof(T) + alignment - 1) / alignment * alignment;
    if (bytes == 0) return;
    data_.reset(static_cast<T*>(std::aligned_alloc(alignment, bytes)));
    if (!data_) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
    if (alignment == kHugePage) madvise(data_.get(), bytes, MADV_HUGEPAGE);  // a wish: without, it is only slower
#endif
  }

  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  size_t size() const { return size_; }
  T& operator[](size_t i) { return data_.get()[i]; }
  const T& operator[](size_t i) const { return data_.get()[i]; }
  operator std::span<const T>() const { return {data(), size_}; }

 private:
  static constexpr size_t kHugePage = size_t{2} << 20;
  static constexpr size_t kCacheLine = 64;

  struct Free {
    void operator()(T* p) const { std::free(p); }
  };
  std::unique_ptr<T, Free> data_;
  size_t size_ = 0;
};

}  // namespace kd
