// The vertex nearest to a point of a Delaunay triangulation: the nearest of its natural neighbours.
//
// The middle between the point and its nearest vertices is nearer to none else, so that these are
// all natural neighbours: cells that the point's own would share a side with.
#pragma once

#include <cstdint>

#include "neighbor_ring.hpp"

namespace tinsmith {

// One for a thread.
class NearestVertex {
 public:
  NearestVertex(const OrderedSurface& ordered, bool from_west)
      : ordered_(ordered), surface_(ordered.surface()), from_west_(from_west) {}

  // Of the vertices nearest to p, which the triangle holds, the one that the caller calls by the
  // smallest number, or the lexicographically first; by that number.
  Vertex find(Point p, Triangle t) { return ordered_.given_number(find_ordered(p, t)); }

 private:
  Vertex find_ordered(Point p, Triangle t) {
    Vertex nearest = surface_.vertex(t, 0);
    for (std::uint32_t k = 1; k < 3; ++k) nearest = nearer(p, nearest, surface_.vertex(t, k));
    if (surface_.point(nearest) == p || !ring_.collect(surface_, nullptr, p, t)) return nearest;
    for (const auto& edge : ring_.ring()) nearest = nearer(p, nearest, edge.start);
    return nearest;
  }

  Vertex nearer(Point p, Vertex one, Vertex other) const {
    const int further = compare_distances(p, surface_.point(one), surface_.point(other));
    if (further == 0 && from_west_) {
      return lexicographically_before(surface_.point(one), surface_.point(other)) ? one : other;
    }
    if (further == 0) {
      return ordered_.given_number(one) < ordered_.given_number(other) ? one : other;
    }
    return further < 0 ? one : other;
  }

  const OrderedSurface& ordered_;
  Surface surface_;
  bool from_west_;
  NeighborRing ring_;
};

}  // namespace tinsmith
