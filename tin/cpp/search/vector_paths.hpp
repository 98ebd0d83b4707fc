// Which vector instructions the growth uses: chosen when it runs, with the same result.
//
// The compiler is told per function what it may use, so one binary runs on every processor of its
// kind. Vectors of two doubles belong to the base of x86-64 (SSE2) and of arm64 (NEON); other
// compilers than GCC and Clang get plain doubles. Eight doubles at once (AVX-512) took 3 % longer
// than four (AVX2): a search is a chain of steps that wait for each other, not much arithmetic.
#pragma once

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "neighborhood.hpp"

#if defined(__GNUC__) && defined(__x86_64__)  // Clang says __GNUC__ too
#define TINSMITH_HAS_AVX
#include <immintrin.h>
#endif

#define TINSMITH_PATH plain
#define TINSMITH_LANES 1
#include "vector_neighborhood.inc"

#if defined(__GNUC__)
#define TINSMITH_PATH base
#define TINSMITH_LANES 2
#include "vector_neighborhood.inc"
#endif

#ifdef TINSMITH_HAS_AVX
#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
#define TINSMITH_PATH avx2
#define TINSMITH_LANES 4
#include "vector_neighborhood.inc"
#ifdef __clang__
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

namespace tinsmith {

enum class VectorPath { kPlain, kBase, kAvx2 };

struct NamedPath {
  VectorPath path;
  const char* name;
};

// The paths that this processor can take, slowest first.
inline std::vector<NamedPath> vector_paths() {
  std::vector<NamedPath> paths{{VectorPath::kPlain, "plain"}};
#ifdef __GNUC__
  paths.push_back({VectorPath::kBase, "base"});
#endif
#ifdef TINSMITH_HAS_AVX
  if (__builtin_cpu_supports("avx2")) paths.push_back({VectorPath::kAvx2, "avx2"});
#endif
  return paths;
}

inline VectorPath vector_path_named(const std::string& name) {
  for (const NamedPath& path : vector_paths()) {
    if (path.name == name) return path.path;
  }
  throw std::invalid_argument("no such vector path on this processor: " + name);
}

template <typename VectorNeighborhood>
struct PathTag {
  using Type = VectorNeighborhood;
};

// visit(tag) with the neighbourhood that is compiled for the path as tag::Type.
template <typename Visit>
auto with_path(VectorPath path, Visit&& visit) {
  switch (path) {
#ifdef TINSMITH_HAS_AVX
    case VectorPath::kAvx2:
      return visit(PathTag<avx2::VectorNeighborhood>{});
#endif
#ifdef __GNUC__
    case VectorPath::kBase:
      return visit(PathTag<base::VectorNeighborhood>{});
#endif
    default:
      return visit(PathTag<plain::VectorNeighborhood>{});
  }
}

}  // namespace tinsmith
