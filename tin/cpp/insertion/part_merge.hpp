// Triangulations on both sides of a line, made one.
//
// The merge of Guibas and Stolfi, "Primitives for the manipulation of general subdivisions and the
// computation of Voronoi diagrams" (1985): from the lower common tangent upwards a triangle is
// grown on the edge between both sides, to the next vertex of either, and triangles of one side
// whose circles hold the vertex across are removed on the way.
//
//        p.                .q       the edge from a to b is the top of what is done. Of the hulls
//        |.\ .          ./ |        p and q are next to a and b; while the circle of a, b, p holds
//        |.. a---------- b.|        the vertex behind the edge from a to p, the triangle there is
//        |../ ..       ....|        removed, and that vertex is p. Then the circle of a, b, p that
//                                   does not hold q, or the one of a, b, q, is a triangle's.
//
// Both meshes are closed by ghosts, and so they remain: a removed triangle leaves one ghost more,
// a new one takes the place of a ghost. An edge with ghosts on both sides is a bridge between what
// is left of one side; it stays, for the vertices of a half-plane hang together by edges of the
// triangulation of all.
#pragma once

#include <cstdint>

#include "../base/ids.hpp"
#include "../base/point.hpp"
#include "../predicates/predicates.hpp"
#include "ghost_mesh.hpp"

namespace tinsmith {

class PartMerge {
 public:
  // `points` by vertex.
  PartMerge(GhostTriangle* triangles, const Point* points)
      : triangles_(triangles), points_(points) {}

  // A vertex of the hull with a triangle at it.
  struct OnHull {
    Vertex vertex;
    Triangle triangle;
  };

  // From any triangle at the vertex. What is found stays at the vertex in one merge.
  OnHull on_hull(Vertex v, Triangle triangle) const { return {v, ghost_from(v, triangle)}; }

  // Merge what is left of a line with what is right of it. Both vertices are the nearest to the
  // line; `below` and `above` are numbers that no triangle has, for ghosts at the tangents.
  void run(OnHull on_left, OnHull on_right, Triangle below, Triangle above) {
    a_ = on_left.vertex;
    b_ = on_right.vertex;
    find_lower_tangent(on_left.triangle, on_right.triangle);
    const Triangle before = previous(left_), after = next(right_);
    set_ghost(below, a_, b_);
    link(before, below);
    link(below, after);
    base_ = half_edge(below, 0);
    while (grow()) {
    }
    set_ghost(above, b_, a_);
    join(half_edge(above, 0), base_);
    link(right_, above);
    link(above, left_);
  }

 private:
  GhostTriangle& at(Triangle t) const { return triangles_[number(t)]; }
  Point point(Vertex v) const { return points_[number(v)]; }

  void join(HalfEdge e, HalfEdge f) {
    at(triangle_of(e)).twin[corner_of(e)] = f;
    at(triangle_of(f)).twin[corner_of(f)] = e;
  }

  // ------------------------------------------------------------- ghosts
  // That of the hull's edge from u to v (the hull on its left) has the corners ghost, v, u.

  std::uint32_t ghost_corner(Triangle ghost) const {
    const GhostTriangle& triangle = at(ghost);
    return triangle.corner[0] == kGhost ? 0 : triangle.corner[1] == kGhost ? 1 : 2;
  }
  Vertex from(Triangle ghost) const { return at(ghost).corner[corner_before(ghost_corner(ghost))]; }
  Vertex to(Triangle ghost) const { return at(ghost).corner[corner_after(ghost_corner(ghost))]; }
  HalfEdge behind(Triangle ghost) const { return at(ghost).twin[ghost_corner(ghost)]; }
  Triangle next(Triangle ghost) const {
    return triangle_of(at(ghost).twin[corner_before(ghost_corner(ghost))]);
  }
  Triangle previous(Triangle ghost) const {
    return triangle_of(at(ghost).twin[corner_after(ghost_corner(ghost))]);
  }
  void link(Triangle ghost, Triangle next) {
    join(half_edge(ghost, corner_before(ghost_corner(ghost))),
         half_edge(next, corner_after(ghost_corner(next))));
  }
  void set_ghost(Triangle ghost, Vertex from, Vertex to) {
    at(ghost).corner[0] = kGhost;
    at(ghost).corner[1] = to;
    at(ghost).corner[2] = from;
  }

  // The ghost of the hull's edge from the vertex, by turning about it.
  Triangle ghost_from(Vertex v, Triangle triangle) const {
    for (;;) {
      const GhostTriangle& turned = at(triangle);
      const std::uint32_t corner = turned.corner[0] == v ? 0 : turned.corner[1] == v ? 1 : 2;
      if (turned.corner[corner_after(corner)] == kGhost) return triangle;
      triangle = triangle_of(turned.twin[corner_after(corner)]);
    }
  }

  // ------------------------------------------------------------- the merge

  // Down both hulls while one sees the other's vertex.
  void find_lower_tangent(Triangle at_a, Triangle at_b) {
    left_ = ghost_from(a_, at_a);
    Triangle from_b = ghost_from(b_, at_b);
    for (;;) {
      const Triangle before = previous(left_);
      if (orientation(point(from(before)), point(a_), point(b_)) < 0) {
        left_ = before;
        a_ = from(left_);
      } else if (orientation(point(b_), point(to(from_b)), point(a_)) < 0) {
        from_b = next(from_b);
        b_ = from(from_b);
      } else {
        break;
      }
    }
    right_ = previous(from_b);
  }

  // One triangle on the base. False if that is the upper tangent.
  bool grow() {
    const bool has_left = is_above(to(left_));
    const bool has_right = is_above(from(right_));
    if (has_left) remove_left();
    if (has_right) remove_right();
    const Vertex p = to(left_), q = from(right_);
    if (has_right && (!has_left || is_in_circle(point(a_), point(b_), point(p), point(q)))) {
      add_right(q);
    } else if (has_left) {
      add_left(p);
    }
    return has_left || has_right;
  }

  bool is_above(Vertex v) const { return orientation(point(a_), point(b_), point(v)) > 0; }

  // Whether the triangle behind a ghost goes, of whose edge `third` is one vertex.
  bool is_removed(HalfEdge behind, Vertex third) const {
    const Vertex apex = at(triangle_of(behind)).corner[corner_of(behind)];
    return apex != kGhost && is_in_circle(point(a_), point(b_), point(third), point(apex));
  }

  void remove_left() {
    for (HalfEdge edge = behind(left_); is_removed(edge, to(left_)); edge = behind(left_)) {
      const Triangle after = next(left_), upper = triangle_of(edge);
      open_triangle(edge, left_, upper);
      link(left_, upper);
      link(upper, after);
    }
  }

  void remove_right() {
    for (HalfEdge edge = behind(right_); is_removed(edge, from(right_)); edge = behind(right_)) {
      const Triangle before = previous(right_), upper = right_, lower = triangle_of(edge);
      open_triangle(edge, upper, lower);
      link(before, upper);
      link(upper, lower);
      right_ = lower;
    }
  }

  // Instead of a triangle behind a ghost, ghosts of its two other edges, from u over the apex to v.
  void open_triangle(HalfEdge edge, Triangle first, Triangle second) {
    const GhostTriangle removed = at(triangle_of(edge));
    const std::uint32_t corner = corner_of(edge);
    const Vertex apex = removed.corner[corner];
    const Vertex u = removed.corner[corner_after(corner)];
    const Vertex v = removed.corner[corner_before(corner)];
    const HalfEdge beyond_first = removed.twin[corner_before(corner)];
    const HalfEdge beyond_second = removed.twin[corner_after(corner)];
    set_ghost(first, u, apex);
    set_ghost(second, apex, v);
    join(half_edge(first, 0), beyond_first);
    join(half_edge(second, 0), beyond_second);
  }

  // Triangle a, b, p in the place of the ghost of the edge from a to p.
  void add_left(Vertex p) {
    const Triangle made = left_;
    const HalfEdge outer = behind(made);
    left_ = next(made);
    add(made, p);
    join(half_edge(made, 1), outer);
    base_ = half_edge(made, 0);
    a_ = p;
  }

  // Triangle a, b, q in the place of the ghost of the edge from q to b.
  void add_right(Vertex q) {
    const Triangle made = right_;
    const HalfEdge outer = behind(made);
    right_ = previous(made);
    add(made, q);
    join(half_edge(made, 0), outer);
    base_ = half_edge(made, 1);
    b_ = q;
  }

  void add(Triangle made, Vertex apex) {
    at(made).corner[0] = a_;
    at(made).corner[1] = b_;
    at(made).corner[2] = apex;
    join(half_edge(made, 2), base_);
  }

  GhostTriangle* triangles_;
  const Point* points_;
  Vertex a_{}, b_{};           // the base's
  HalfEdge base_{};            // as seen from below
  Triangle left_{}, right_{};  // ghosts of the edges from a and to b
};

}  // namespace tinsmith
