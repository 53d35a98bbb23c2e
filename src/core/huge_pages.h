// Memory for large tables that are read all over: in pages of 2 MiB where the system gives them.
//
// With pages of 4 KiB nearly every such read also misses the processor's table of pages, and a prefetch then waits for
// the table to be walked.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace nephroid {

template <class T>
struct HugePageAllocator {
  using value_type = T;

  HugePageAllocator() = default;
  template <class U>
  explicit HugePageAllocator(const HugePageAllocator<U>& /*other*/) {}

  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    void* memory = ::operator new(bytes, alignmentFor(count));
#ifdef __linux__
    // Only advice: without it the same memory serves, slower.
    if (bytes >= kHugePage) madvise(memory, bytes, MADV_HUGEPAGE);
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) { ::operator delete(memory, alignmentFor(count)); }

  bool operator==(const HugePageAllocator&) const { return true; }

 private:
  static constexpr std::size_t kHugePage = std::size_t{2} << 20;
  static std::align_val_t alignmentFor(std::size_t count) {
    return std::align_val_t{count * sizeof(T) >= kHugePage ? kHugePage : alignof(T)};
  }
};

template <class T>
using HugePageVector = std::vector<T, HugePageAllocator<T>>;

}  // namespace nephroid
