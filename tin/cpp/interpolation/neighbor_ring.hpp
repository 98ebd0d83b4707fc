// The triangles of a constrained Delaunay triangulation whose circles hold a point, and the ring of
// vertices around them: the natural neighbours of the point.
//
// They are what insertion would replace (A. Bowyer, 1981; D. F. Watson, 1981). Edges that are
// barriers are not looked across: a vertex behind one is no natural neighbour.
//
//         v2 ----- v1         ring edge i leads from vertex i to i + 1, counter-clockwise, and has
//        /  \  T1 /  \        the cavity's triangle on its left; an inner edge has one on both
//       /    \   /    \       sides, and both its ends on the ring.
//     v3  T2  \ /  T0  v0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "barriers.hpp"

namespace tinsmith {

class NeighborRing {
 public:
  struct RingEdge {
    Vertex start;
    std::int32_t triangle;  // place in triangles()
  };
  struct InnerEdge {
    std::int32_t start, end;        // places on the ring
    std::int32_t triangle, beyond;  // with the edge counter-clockwise, and across it
  };

  // The surface must be Delaunay but for its barriers; p lies in `first` and at none of its
  // corners. False if the triangles do not fit together.
  bool collect(const Surface& surface, const bool* barriers, Point p, Triangle first) {
    clear();
    triangles_.push_back(first);
    // Opposite the corners 2, 0, 1 stand the edges that follow each other counter-clockwise.
    for (const std::uint32_t k : {1u, 0u, 2u}) open_.push_back({first, k, 0});
    while (!open_.empty()) {
      const OpenEdge edge = open_.back();
      open_.pop_back();
      if (edge.corner == kEndOfInnerEdge) {
        inner_[edge.place].end = static_cast<std::int32_t>(ring_.size());
      } else if (!cross(surface, barriers, p, edge)) {
        ring_.push_back({surface.vertex(edge.triangle, corner_after(edge.corner)), edge.place});
      }
      if (triangles_.size() > surface.triangle_count) return false;
    }
    close();
    return true;
  }

  const std::vector<Triangle>& triangles() const { return triangles_; }
  const std::vector<RingEdge>& ring() const { return ring_; }
  const std::vector<InnerEdge>& inner_edges() const { return inner_; }

 private:
  static constexpr std::uint32_t kEndOfInnerEdge = 3;

  struct OpenEdge {
    Triangle triangle;
    std::uint32_t corner;  // opposite the edge, or kEndOfInnerEdge
    std::int32_t place;    // in triangles_, or of the inner edge
  };

  void clear() {
    triangles_.clear();
    ring_.clear();
    inner_.clear();
    open_.clear();
  }

  // Go on beyond an edge if the triangle there belongs to the cavity.
  bool cross(const Surface& surface, const bool* barriers, Point p, OpenEdge edge) {
    if (!is_open(surface, barriers, edge.triangle, edge.corner)) return false;
    const Triangle beyond = surface.neighbor(edge.triangle, edge.corner);
    if (in_circle(surface.corner(beyond, 0), surface.corner(beyond, 1), surface.corner(beyond, 2),
                  p) <= 0) {
      return false;
    }
    const auto place = static_cast<std::int32_t>(triangles_.size());
    const auto start = static_cast<std::int32_t>(ring_.size());
    const std::uint32_t apex = surface.corner_facing(beyond, edge.triangle);
    triangles_.push_back(beyond);
    open_.push_back({beyond, kEndOfInnerEdge, static_cast<std::int32_t>(inner_.size())});
    inner_.push_back({start, start, edge.place, place});
    open_.push_back({beyond, corner_before(apex), place});
    open_.push_back({beyond, corner_after(apex), place});
    return true;
  }

  // The ring ends where it begins.
  void close() {
    const auto size = static_cast<std::int32_t>(ring_.size());
    for (InnerEdge& edge : inner_) {
      if (edge.end == size) edge.end = 0;
    }
  }

  std::vector<Triangle> triangles_;
  std::vector<RingEdge> ring_;
  std::vector<InnerEdge> inner_;
  std::vector<OpenEdge> open_;
};

}  // namespace tinsmith
