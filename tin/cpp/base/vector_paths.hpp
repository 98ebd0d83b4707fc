// Which vector instructions a loop uses: chosen when it runs, with the same result to the last bit.
//
// The compiler is told per function what it may use, so one binary runs on every processor of its
// kind. Vectors of two doubles belong to the base of x86-64 (SSE2) and of arm64 (NEON); other
// compilers than GCC and Clang get plain doubles. A loop stands in a file of its own, which
// each_vector_path.inc compiles for every path in a namespace of the path's name.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#if defined(__GNUC__)  // Clang says so too
#define TINSMITH_HAS_VECTORS
#if defined(__x86_64__)
#define TINSMITH_HAS_AVX
#include <immintrin.h>
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
#ifdef TINSMITH_HAS_VECTORS
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

// Where a compiler has no such vectors, the name of their path stands for the one before it.
namespace plain {}
#ifdef TINSMITH_HAS_VECTORS
namespace base {}
#else
namespace base = plain;
#endif
#ifndef TINSMITH_HAS_AVX
namespace avx2 = base;
#endif

}  // namespace tinsmith
