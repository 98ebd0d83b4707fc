// The walk along a straight line to the triangle that holds a point.
//
// A walk that crosses any edge with the point on its other side (the visibility walk of Devillers,
// Pion and Teillaud, "Walking in a triangulation", 2002) is the quickest where triangles are well
// shaped. Among slivers it strays: from a triangle between two neighbours and a far vertex it may
// go round all of that vertex. The straight walk of the same paper meets only the triangles that
// the segment from a vertex to the point crosses:
//
//            left                  the segment leaves the triangle across the edge between the last
//          .  |   .                vertex to its left and the last to its right; the vertex of the
//      from --|---- . -> p         next triangle replaces one of the two. Vertices on the line
//          .  |   .                count as left, so no case is special.
//            right
#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>

#include "../predicates/predicates.hpp"
#include "ghost_mesh.hpp"

namespace tinsmith {

// `triangle_at(t)` gives a GhostTriangle, `point_at(vertex)` a Point.
template <typename TriangleAt, typename PointAt>
class StraightWalk {
 public:
  // No walk meets more than the `triangle_count` triangles that there are.
  StraightWalk(TriangleAt triangle_at, PointAt point_at, std::uint32_t triangle_count)
      : triangle_at_(triangle_at), point_at_(point_at), triangle_count_(triangle_count) {}

  // A triangle that holds p, on its boundary too; or the ghost of a hull edge that p lies beyond,
  // or on. The walk begins at a corner of the triangle `start`.
  Triangle find(Point p, Triangle start) {
    const HalfEdge sector = find_sector(p, real_side(start));
    return is_ghost_at(sector) ? triangle_of(sector) : follow(p, sector);
  }

  // Triangles looked at so far.
  std::int64_t steps() const { return steps_; }

 private:
  const GhostTriangle& at(HalfEdge edge) const { return triangle_at_(triangle_of(edge)); }
  Vertex apex(HalfEdge edge) const { return at(edge).corner[corner_of(edge)]; }
  Vertex right(HalfEdge edge) const { return at(edge).corner[corner_after(corner_of(edge))]; }
  Vertex left(HalfEdge edge) const { return at(edge).corner[corner_before(corner_of(edge))]; }
  bool is_ghost_at(HalfEdge edge) const {
    return apex(edge) == kGhost || right(edge) == kGhost || left(edge) == kGhost;
  }

  // The triangle after this one, counter-clockwise about its corner, as the edge opposite it.
  HalfEdge turn(HalfEdge edge) const {
    const HalfEdge across = at(edge).twin[corner_after(corner_of(edge))];
    return half_edge(triangle_of(across), corner_after(corner_of(across)));
  }

  // The triangle itself, or the one on the other side of a ghost's hull edge.
  Triangle real_side(Triangle t) const {
    const GhostTriangle& triangle = triangle_at_(t);
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (triangle.corner[k] == kGhost) return triangle_of(triangle.twin[k]);
    }
    return t;
  }

  // Does the segment from the edge's opposite corner to p begin in its triangle? For a ghost: is p
  // beyond the hull edge there, or on it? (Not so on the line past its end: then other corners of
  // the first triangle, which are not on that line, tell.)
  bool holds_direction(HalfEdge edge, Point p) const {
    const Vertex a = right(edge), b = left(edge);
    const Point from = point_at_(apex(edge));
    if (b == kGhost) return orientation(point_at_(a), from, p) < 0;
    if (a != kGhost) {
      return orientation(from, p, point_at_(a)) < 0 && orientation(from, p, point_at_(b)) >= 0;
    }
    const int side = orientation(from, point_at_(b), p);
    return side < 0 || (side == 0 && is_between(from, point_at_(b), p));
  }

  // Of three points on a line: is p between the others?
  static bool is_between(Point a, Point b, Point p) {
    return lexicographically_before(a, b)
               ? lexicographically_before(a, p) && lexicographically_before(p, b)
               : lexicographically_before(b, p) && lexicographically_before(p, a);
  }

  // Turns about the corners of one triangle by turns, each time twice as far, until a sector is
  // found: some times the steps about the corner with the fewest triangles.
  HalfEdge find_sector(Point p, Triangle start) {
    std::array<HalfEdge, 3> edges{};
    for (std::uint32_t k = 0; k < 3; ++k) {
      edges[k] = half_edge(start, k);
      if (point_at_(apex(edges[k])) == p) return edges[k];
    }
    for (std::int64_t turns = kUsualTurns; turns < 2 * std::int64_t{triangle_count_} + kUsualTurns;
         turns *= 2) {
      for (HalfEdge& edge : edges) {
        for (std::int64_t i = 0; i < turns; ++i, ++steps_, edge = turn(edge)) {
          if (holds_direction(edge, p)) return edge;
        }
      }
    }
    throw std::logic_error("no triangle about a vertex lies towards the point sought");
  }

  bool is_right_of(Vertex a, Vertex b, Point p) const {
    return orientation(point_at_(a), point_at_(b), p) < 0;
  }

  Triangle follow(Point p, HalfEdge edge) {
    const Point from = point_at_(apex(edge));
    Vertex a = right(edge), b = left(edge);
    for (std::uint32_t most = triangle_count_; is_right_of(a, b, p); --most) {
      if (most == 0) throw std::logic_error("a walk along a line did not arrive");
      ++steps_;
      const HalfEdge across = at(edge).twin[corner_of(edge)];
      const Vertex ahead = apex(across);
      if (ahead == kGhost) return triangle_of(across);
      const std::uint32_t corner = corner_of(across);
      const bool is_left = orientation(from, p, point_at_(ahead)) >= 0;
      (is_left ? b : a) = ahead;
      edge = half_edge(triangle_of(across), is_left ? corner_after(corner) : corner_before(corner));
    }
    return triangle_of(edge);
  }

  static constexpr std::int64_t kUsualTurns = 8;  // a vertex has six triangles on average

  TriangleAt triangle_at_;
  PointAt point_at_;
  std::uint32_t triangle_count_;
  std::int64_t steps_ = 0;
};

}  // namespace tinsmith
