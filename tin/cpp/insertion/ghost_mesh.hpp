// A triangulation closed to a sphere, so that insertion needs no special case at the hull.
//
// One ghost vertex stands outside; a ghost triangle joins it to every hull edge, and its circle is
// the open half-plane beyond that edge. n points make 2n - 2 triangles, ghosts included.
//
// Six numbers a triangle, together in memory: a step of a walk touches one place.
//
//              corner 2                 twin k: the edge opposite corner k, as seen from the
//              .      .                 triangle across it: 4 * triangle + place of the corner
//      edge 1 .        . edge 0         opposite the edge there.
//            .          .
//      corner 0 ..edge 2.. corner 1
#pragma once

#include <cstdint>

#include "../base/arrays.hpp"

namespace tinsmith {

// The ghost's number, before all vertices; arrays by vertex have a place for it at their front.
constexpr std::int32_t kGhost = -1;

struct GhostTriangle {
  std::int32_t corner[3];
  std::uint32_t twin[3];
};

struct GhostMesh {
  ScratchArray<GhostTriangle> triangles;
  std::uint32_t count = 0;
};

// An edge as seen from one triangle. (Numbers of 32 bits hold 4 * 2n for the most points allowed.)
inline std::uint32_t mesh_edge(std::uint32_t triangle, std::uint32_t place) {
  return 4 * triangle + place;
}
inline std::uint32_t triangle_of(std::uint32_t edge) { return edge >> 2; }
inline std::uint32_t place_of(std::uint32_t edge) { return edge & 3; }

// The places 1, 2, 0 and 2, 0, 1 as digits of a number: a branch on the place would be guessed
// wrongly half of the time.
inline std::uint32_t place_after(std::uint32_t place) { return (0x09u >> (2 * place)) & 3; }
inline std::uint32_t place_before(std::uint32_t place) { return (0x12u >> (2 * place)) & 3; }

}  // namespace tinsmith
