// Arrays of plain values, not initialised, for many megabytes.
//
// A scratch array lies in large pages and is the system's again as soon as it is freed. malloc
// keeps what is freed, and the next stage's arrays come on top of it: the stages of insertion,
// which use all their memory but once, would hold a quarter more at the peak. And what malloc
// hands out again lies in small pages, which costs the stages that jump about a tenth.
//
// A streamed array is written once, from front to back, and handed over: a small page that the
// system has just cleared is still in the cache when it is written, and a large one is not.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>
#if defined(__linux__)
#include <sys/mman.h>
#endif
#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace tinsmith {

struct ReleaseMemory {
  std::size_t mapped_bytes = 0;  // 0 if the memory is malloc's

  void operator()(void* memory) const {
#if defined(__linux__)
    if (mapped_bytes > 0) {
      munmap(memory, mapped_bytes);
      return;
    }
#endif
    std::free(memory);
  }
};

template <typename T>
using ScratchArray = std::unique_ptr<T[], ReleaseMemory>;

// How much of so many bytes is mapped: all or nothing.
inline std::size_t mapped_bytes(std::size_t size) {
#if defined(__linux__)
  constexpr std::size_t kWorthMapping = std::size_t{4} << 20;  // holds a large page for certain
  return size >= kWorthMapping ? size : 0;
#else
  return 0 * size;
#endif
}

template <typename T>
ScratchArray<T> scratch_array(std::size_t count) {
  static_assert(std::is_trivially_destructible_v<T>);
  const std::size_t size = count * sizeof(T);
#if defined(__linux__)
  if (mapped_bytes(size) > 0) {
    void* const memory =
        mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    madvise(memory, size, MADV_HUGEPAGE);  // a wish: refusal does no harm
    return ScratchArray<T>(static_cast<T*>(memory), ReleaseMemory{size});
  }
#endif
  void* const memory = std::malloc(size > 0 ? size : 1);
  if (memory == nullptr) throw std::bad_alloc();
  return ScratchArray<T>(static_cast<T*>(memory));
}

// Give what malloc keeps back to the system, before a stage that needs much memory of its own.
inline void release_freed_memory() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

// A scratch array that grows. What is made without a value holds anything.
template <typename T>
struct ScratchMemory {
  using value_type = T;

  ScratchMemory() = default;
  template <typename U>
  ScratchMemory(const ScratchMemory<U>&) {}

  T* allocate(std::size_t count) { return scratch_array<T>(count).release(); }
  void deallocate(T* memory, std::size_t count) {
    ReleaseMemory{mapped_bytes(count * sizeof(T))}(memory);
  }
  template <typename U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <typename U, typename... Given>
  void construct(U* place, Given&&... given) {
    ::new (static_cast<void*>(place)) U(std::forward<Given>(given)...);
  }
  friend bool operator==(const ScratchMemory&, const ScratchMemory&) { return true; }
  friend bool operator!=(const ScratchMemory&, const ScratchMemory&) { return false; }
};

template <typename T>
using ScratchVector = std::vector<T, ScratchMemory<T>>;

// Empty a vector and give up its memory, which `v = {}` keeps: it assigns an empty list of values.
template <typename T, typename Memory>
void free_memory(std::vector<T, Memory>& v) {
  std::vector<T, Memory>().swap(v);
}

struct FreeMemory {
  void operator()(void* memory) const { std::free(memory); }
};

template <typename T>
using StreamedArray = std::unique_ptr<T[], FreeMemory>;

template <typename T>
StreamedArray<T> streamed_array(std::size_t count) {
  static_assert(std::is_trivially_destructible_v<T>);
  void* const memory = std::malloc(count > 0 ? count * sizeof(T) : 1);
  if (memory == nullptr) throw std::bad_alloc();
  return StreamedArray<T>(static_cast<T*>(memory));
}

// A streamed array for a stage that writes faster than the system clears small pages.
template <typename T>
StreamedArray<T> quickly_streamed_array(std::size_t count) {
#if defined(__linux__)
  static_assert(std::is_trivially_destructible_v<T>);
  constexpr std::size_t kLargePage = std::size_t{2} << 20;
  const std::size_t size = count * sizeof(T);
  if (mapped_bytes(size) > 0) {
    void* memory = nullptr;
    if (posix_memalign(&memory, kLargePage, size) != 0) throw std::bad_alloc();
    madvise(memory, size / kLargePage * kLargePage, MADV_HUGEPAGE);
    return StreamedArray<T>(static_cast<T*>(memory));
  }
#endif
  return streamed_array<T>(count);
}

}  // namespace tinsmith
