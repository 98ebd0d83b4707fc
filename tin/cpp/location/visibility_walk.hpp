// The visibility walk: from triangle to triangle to the one that holds a point.
//
// Devillers, Pion and Teillaud, "Walking in a triangulation" (2002):
//
//            apex               Each step leaves a triangle across an edge that has the point p on
//           .    .              its other side; where no edge has, the walk is there. Which one of
//   p .   .        .            two such edges is taken makes the kinds of this walk, and is the
//        left --- right         caller's choice. Among Delaunay triangles any walk ends; among
//              ^                others one could go round and round, and among slivers it strays:
//            entry              so there is a limit, and the caller knows what to do beyond it.
#pragma once

#include <cstdint>

#include "../base/ids.hpp"

namespace tinsmith {

// The half-edge with which a walk begins in a triangle that was not entered.
constexpr HalfEdge unentered(Triangle t) { return half_edge(t, kNoCorner); }

// next(entry) of the half-edge by which a triangle was entered is the one by which the next triangle
// is entered; the same one where the walk ends; kNoHalfEdge where it cannot go on. Returns the last
// entry, or kNoHalfEdge if `most_steps` triangles were too few.
template <typename Next>
HalfEdge walk_towards(HalfEdge entry, std::uint32_t most_steps, Next&& next) {
  for (; most_steps > 0 && entry != kNoHalfEdge; --most_steps) {
    const HalfEdge beyond = next(entry);
    if (beyond == entry) return entry;
    entry = beyond;
  }
  return kNoHalfEdge;
}

}  // namespace tinsmith
