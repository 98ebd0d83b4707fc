// The domain of influence of a new point: carve it out of the mesh and fill it with a fan.
//
// Bowyer, "Computing Dirichlet tessellations", and Watson, "Computing the n-dimensional Delaunay
// tessellation with application to Voronoi polytopes" (both 1981).
//
// The triangles whose circle holds the point hang together and surround no vertex, so they form a
// tree: crossing from one into the next through an edge never meets a triangle twice.
//
//        .-------.            edges yet to cross stand in a queue; each leads to a triangle that
//       / \ ... / \           either goes, and adds its two other edges, or stays: then the edge
//      /...\.p./...\          is on the boundary. In the end each edge there gets a triangle of
//     .-----.-.-----.         the fan about p, in the places of those removed and two new ones.
//      \ ..../.\... /
//       `---'   `--'
//
// Whether a triangle goes is a guess at even odds, so nothing branches on it: both outcomes are
// written, and a counter moves past one of them. Then the tests of several edges overlap.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "../base/rare.hpp"
#include "../predicates/predicates.hpp"
#include "ghost_mesh.hpp"

namespace tinsmith {

class Cavity {
 public:
  // `points` by vertex; the ghost's coordinates are not numbers, so that no test with it is
  // certain in floating point and all come to the exact one. New triangles are numbered from
  // `unused` on.
  Cavity(GhostTriangle* triangles, Triangle unused, const Point* points)
      : triangles_(triangles), unused_(number(unused)), points_(points) {
    reserve(kUsualRoom);
  }

  // Insert a vertex whose domain of influence holds the triangle `first`. Returns a triangle of
  // the fan that is no ghost.
  Triangle insert(Vertex vertex, Triangle first) {
    begin(point(vertex), first);
    while (!spread()) reserve(2 * room_);
    return fill(vertex);
  }

 private:
  static constexpr std::uint32_t kUsualRoom = 64;  // grows where a point has more neighbours

  // Shewchuk's bound holds for terms |a|^2 (|bx cy| + |cx by|) and the like, and the second factor
  // is at most (|b|^2 + |c|^2) / 2. The sum is looser than his but needs no absolute values; a
  // tenth more covers its own rounding.
  static constexpr double kLiftBound = 11.0 * kUnitRoundoff;

  struct Corner {  // of the cavity, as seen from p
    double x, y;
    double lift;  // squared distance
    Vertex vertex;
  };
  // Two corners by number, counter-clockwise about p; one value, so that it is moved as one.
  class Ends {
   public:
    Ends() = default;
    Ends(std::uint64_t from, std::uint64_t to) : both_(from | to << 32) {}
    std::uint64_t from() const { return both_ & 0xFFFFFFFFu; }
    std::uint64_t to() const { return both_ >> 32; }

   private:
    std::uint64_t both_;
  };
  struct Edge {
    double cross;  // of its corners: twice the area of the triangle it makes with p
    Ends ends;
    HalfEdge outer;  // as seen from the triangle across
  };
  struct BoundaryEdge {
    Ends ends;
    HalfEdge outer;
  };
  struct Spokes {  // the edges of the fan at a corner, before and after it
    HalfEdge before, after;
  };

  void reserve(std::uint32_t room) {
    room_ = room;
    corners_.resize(room + 3);
    edges_.resize(2 * room + 5);
    boundary_.resize(room + 3);
    removed_.resize(room + 3);
    spokes_.resize(room + 3);
  }

  Point point(Vertex v) const { return points_[number(v)]; }
  GhostTriangle& at(Triangle t) const { return triangles_[number(t)]; }

  Corner corner(Vertex vertex) const {
    const double x = point(vertex).x - p_.x, y = point(vertex).y - p_.y;
    return {x, y, x * x + y * y, vertex};
  }

  static double cross(const Corner& a, const Corner& b) { return a.x * b.y - a.y * b.x; }

  void begin(Point p, Triangle first) {
    p_ = p;
    const GhostTriangle& triangle = at(first);
    for (int i = 0; i < 3; ++i) corners_[i] = corner(triangle.corner[i]);
    edges_[0] = {cross(corners_[0], corners_[1]), {0, 1}, triangle.twin[2]};
    edges_[1] = {cross(corners_[1], corners_[2]), {1, 2}, triangle.twin[0]};
    edges_[2] = {cross(corners_[2], corners_[0]), {2, 0}, triangle.twin[1]};
    removed_[0] = first;
    next_edge_ = 0;
    edge_count_ = 3;
    removed_count_ = 1;
    boundary_count_ = 0;
  }

  // Cross the edges in the queue. False if there is no room for more.
  bool spread() {
    Corner* const corners = corners_.data();
    Edge* const edges = edges_.data();
    BoundaryEdge* const boundary = boundary_.data();
    Triangle* const removed = removed_.data();
    std::uint32_t edge_count = edge_count_, removed_count = removed_count_;
    std::uint32_t boundary_count = boundary_count_, next = next_edge_;
    for (; next < edge_count && removed_count < room_; ++next) {
      const HalfEdge outer = edges[next].outer;
      const std::uint32_t opposite = corner_of(outer);
      const Ends ends = edges[next].ends;
      const Corner& a = corners[ends.from()];
      const Corner& b = corners[ends.to()];
      const GhostTriangle& across = at(triangle_of(outer));
      const Corner c = corner(across.corner[opposite]);
      const double ac = cross(a, c), cb = cross(c, b);
      const double inside = (b.lift * ac + a.lift * cb) - c.lift * edges[next].cross;
      const double bound = kLiftBound * (a.lift * b.lift + c.lift * (a.lift + b.lift));
      std::uint32_t goes = inside > 0.0;
      if (!(std::fabs(inside) > bound)) goes = is_in_conflict(across);

      const std::uint64_t new_corner = removed_count + 2;
      corners[new_corner].x = c.x;
      corners[new_corner].y = c.y;
      corners[new_corner].lift = c.lift;
      corners[new_corner].vertex = c.vertex;
      Edge* const added = edges + edge_count;
      added[0].cross = ac;
      added[0].ends = {ends.from(), new_corner};
      added[0].outer = across.twin[corner_after(opposite)];
      added[1].cross = cb;
      added[1].ends = {new_corner, ends.to()};
      added[1].outer = across.twin[corner_before(opposite)];
      removed[removed_count] = triangle_of(outer);
      boundary[boundary_count].ends = ends;
      boundary[boundary_count].outer = outer;
      edge_count += 2 * goes;
      removed_count += goes;
      boundary_count += 1 - goes;
    }
    edge_count_ = edge_count;
    removed_count_ = removed_count;
    boundary_count_ = boundary_count;
    next_edge_ = next;
    return next == edge_count;
  }

  TINSMITH_RARE bool is_in_conflict(const GhostTriangle& triangle) const {
    const Vertex* c = triangle.corner;
    if (c[0] == kGhost) return is_beyond(point(c[1]), point(c[2]));
    if (c[1] == kGhost) return is_beyond(point(c[2]), point(c[0]));
    if (c[2] == kGhost) return is_beyond(point(c[0]), point(c[1]));
    return is_in_circle(point(c[0]), point(c[1]), point(c[2]), p_);
  }

  // Left of the hull edge (seen from outside), or on it between its ends.
  bool is_beyond(Point from, Point to) const {
    const int side = orientation(from, to, p_);
    if (side != 0) return side > 0;
    const bool is_forward = lexicographically_before(from, to);
    return lexicographically_before(is_forward ? from : to, p_) &&
           lexicographically_before(p_, is_forward ? to : from);
  }

  Triangle fill(Vertex vertex) {
    removed_[removed_count_] = Triangle{unused_++};
    removed_[removed_count_ + 1] = Triangle{unused_++};
    const Triangle* const fan = removed_.data();
    const BoundaryEdge* const boundary = boundary_.data();
    Spokes* const spokes = spokes_.data();
    for (std::uint32_t i = 0; i < boundary_count_; ++i) {
      spokes[boundary[i].ends.from()].after = half_edge(fan[i], 2);
      spokes[boundary[i].ends.to()].before = half_edge(fan[i], 1);
    }
    Triangle some{0};
    for (std::uint32_t i = 0; i < boundary_count_; ++i) {
      const std::uint64_t from = boundary[i].ends.from(), to = boundary[i].ends.to();
      GhostTriangle& made = at(fan[i]);
      made.corner[0] = vertex;
      made.corner[1] = corners_[from].vertex;
      made.corner[2] = corners_[to].vertex;
      made.twin[0] = boundary[i].outer;
      made.twin[1] = spokes[to].after;
      made.twin[2] = spokes[from].before;
      at(triangle_of(boundary[i].outer)).twin[corner_of(boundary[i].outer)] = half_edge(fan[i], 0);
      const bool is_ghost = (number(made.corner[1]) | number(made.corner[2])) < 0;
      some = is_ghost ? some : fan[i];
    }
    return some;
  }

  GhostTriangle* triangles_;
  std::uint32_t unused_;
  const Point* points_;
  Point p_{};
  std::uint32_t room_ = 0;
  std::uint32_t next_edge_ = 0, edge_count_ = 0, removed_count_ = 0, boundary_count_ = 0;
  std::vector<Corner> corners_;  // the first triangle's, then one for each further triangle
  std::vector<Edge> edges_;
  std::vector<BoundaryEdge> boundary_;
  std::vector<Triangle> removed_;
  std::vector<Spokes> spokes_;  // by corner
};

}  // namespace tinsmith
