// A triangulation closed to a sphere, so that insertion needs no special case at the hull.
//
// The vertex at infinity of Boissonnat, Devillers, Pion, Teillaud and Yvinec, "Triangulations in
// CGAL" (2002), here called the ghost.
//
// One ghost vertex stands outside; a ghost triangle joins it to every hull edge, and its circle is
// the open half-plane beyond that edge. n points make 2n - 2 triangles, ghosts included.
//
// Six numbers a triangle, together in memory: a step of a walk touches one place. Twin k is the
// edge opposite corner k, as seen from the triangle across it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"

namespace tinsmith {

// The ghost's number, before all vertices; arrays by vertex have a place for it at their front.
constexpr Vertex kGhost{-1};
// Corner 0 of a place for triangles that holds none.
constexpr Vertex kFree{-2};

struct GhostTriangle {
  Vertex corner[3];
  HalfEdge twin[3];
};

// By vertex, with a place for the ghost in front.
template <typename T>
class WithGhost {
 public:
  explicit WithGhost(std::size_t count) : values_(scratch_array<T>(count + 1)) {}
  T& operator[](Vertex v) { return begin()[number(v)]; }
  const T& operator[](Vertex v) const { return begin()[number(v)]; }
  T* begin() const { return values_.get() + 1; }
  void release() { values_.reset(); }

 private:
  ScratchArray<T> values_;
};

}  // namespace tinsmith
