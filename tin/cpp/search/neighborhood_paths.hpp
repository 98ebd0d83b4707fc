// The neighbourhood of a vertex with the vector instructions of each path. Eight doubles at once
// (AVX-512) took 3 % longer than four (AVX2): a search is a chain of steps that wait for each other,
// not much arithmetic.
#pragma once

#include <cmath>
#include <cstdint>

#include "../base/vector_paths.hpp"
#include "neighborhood.hpp"

#define TINSMITH_LOOPS "../search/vector_neighborhood.inc"
#include "../base/each_vector_path.inc"

namespace tinsmith {

template <typename VectorNeighborhood>
struct PathTag {
  using Type = VectorNeighborhood;
};

// visit(tag) with the neighbourhood that is compiled for the path as tag::Type.
template <typename Visit>
auto with_path(VectorPath path, Visit&& visit) {
  switch (path) {
    case VectorPath::kAvx2:
      return visit(PathTag<avx2::VectorNeighborhood>{});
    case VectorPath::kBase:
      return visit(PathTag<base::VectorNeighborhood>{});
    default:
      return visit(PathTag<plain::VectorNeighborhood>{});
  }
}

}  // namespace tinsmith
