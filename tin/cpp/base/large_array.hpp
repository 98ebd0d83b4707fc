// Arrays of many megabytes, in large pages where the system offers them.
//
// Building the index jumps about in its arrays. With pages of 4 KiB each jump misses the address
// cache; with pages of 2 MiB hardly one does.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>
#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace tinsmith {

struct FreeMemory {
  void operator()(void* memory) const { std::free(memory); }
};

// Plain values, not initialised.
template <typename T>
using LargeArray = std::unique_ptr<T[], FreeMemory>;

// For what is written once, from front to back: a small page that the system has just cleared is
// still in the cache when it is written, and a large one is not.
template <typename T>
LargeArray<T> streamed_array(std::size_t count) {
  static_assert(std::is_trivially_destructible_v<T>);
  void* memory = std::malloc(count > 0 ? count * sizeof(T) : 1);
  if (memory == nullptr) throw std::bad_alloc();
  return LargeArray<T>(static_cast<T*>(memory));
}

// For what is jumped about in.
template <typename T>
LargeArray<T> large_array(std::size_t count) {
  static_assert(std::is_trivially_destructible_v<T>);
  const std::size_t size = count * sizeof(T);
  void* memory = nullptr;
#if defined(__linux__)
  constexpr std::size_t kLargePage = std::size_t{1} << 21;
  if (size >= 2 * kLargePage) {
    memory = std::aligned_alloc(kLargePage, (size + kLargePage - 1) / kLargePage * kLargePage);
    if (memory != nullptr) madvise(memory, size, MADV_HUGEPAGE);  // no more than a wish
  }
#endif
  if (memory == nullptr) memory = std::malloc(size > 0 ? size : 1);
  if (memory == nullptr) throw std::bad_alloc();
  return LargeArray<T>(static_cast<T*>(memory));
}

}  // namespace tinsmith
