// Triangles as a caller has them: flat arrays, three entries a triangle.
#pragma once

#include <cstddef>
#include <cstdint>

#include "../base/ids.hpp"

namespace tinsmith {

// Triangles of the whole convex hull, or of a surface with any boundary: corners, neighbours
// (kNoNeighbor outside) and whether the edge opposite the corner is fixed (null: none is).
struct GivenTriangles {
  const std::int32_t* corners;
  const std::int32_t* neighbors;
  const bool* fixed;
  std::int32_t count;

  // The edge between two triangles, as seen from `across`.
  HalfEdge twin(Triangle t, Triangle across) const {
    const std::int32_t own = index_of(t);
    const std::int32_t* const back = neighbors + entry_of(across, 0);
    return half_edge(across, (back[1] == own) + 2u * (back[2] == own));
  }
  std::uint8_t fixed_bits(Triangle t) const {
    if (fixed == nullptr) return 0;
    const bool* const own = fixed + entry_of(t, 0);
    return static_cast<std::uint8_t>(own[0] | own[1] << 1 | own[2] << 2);
  }
};

}  // namespace tinsmith
