// Insertion of the points of one part, in rounds along its curve.
#pragma once

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "../base/ids.hpp"
#include "../base/range.hpp"
#include "../location/visibility_walk.hpp"
#include "../predicates/predicates.hpp"
#include "cavity.hpp"
#include "curve_order.hpp"
#include "ghost_mesh.hpp"
#include "insertion_rounds.hpp"
#include "straight_walk.hpp"

namespace tinsmith {

// The triangles of a part stand from number 2 * part.begin on; two numbers less than there are for
// its points, for the ghost at infinity is a vertex, too.
class PartInsertion {
 public:
  PartInsertion(CurveOrder& order, Range part, GhostTriangle* triangles)
      : order_(order), points_(order.points.begin()), part_(part), triangles_(triangles) {}

  // Returns false if `keep_going` did, which is told how many points were inserted since it was
  // asked last.
  template <typename KeepGoing>
  bool run(KeepGoing&& keep_going) {
    start();
    return insert_all(keep_going);
  }

  // A triangle at the vertex.
  Triangle triangle_at(Vertex v) { return find_conflict(point(v), last_); }

  // Triangles that were walked through to find where points go.
  std::int64_t walk_steps() const { return walk_steps_; }

 private:
  Point point(Vertex v) const { return points_[number(v)]; }

  // The first triangle, of points that are not in line, and a ghost on each of its edges.
  void start() {
    const Vertex first{part_.begin}, second{part_.begin + 1}, third{part_.begin + 2};
    swap_points(second, Vertex{part_.begin + part_.size() / 2});
    swap_points(third, not_in_line(first, second));
    const bool is_left = orientation(point(first), point(second), point(third)) > 0;
    const Vertex a = first, b = is_left ? second : third, c = is_left ? third : second;
    const std::uint32_t slot = 2 * static_cast<std::uint32_t>(part_.begin);
    const Triangle t{slot}, u{slot + 1}, v{slot + 2}, w{slot + 3};
    at(t) = {{a, b, c}, {half_edge(u, 0), half_edge(v, 0), half_edge(w, 0)}};
    at(u) = {{kGhost, c, b}, {half_edge(t, 0), half_edge(w, 2), half_edge(v, 1)}};
    at(v) = {{kGhost, a, c}, {half_edge(t, 1), half_edge(u, 2), half_edge(w, 1)}};
    at(w) = {{kGhost, b, a}, {half_edge(t, 2), half_edge(v, 2), half_edge(u, 1)}};
    last_ = t;
  }

  GhostTriangle& at(Triangle t) const { return triangles_[number(t)]; }

  Vertex not_in_line(Vertex a, Vertex b) const {
    for (const Vertex c : Ids<Vertex>(part_.begin, part_.end)) {
      if (orientation(point(a), point(b), point(c)) != 0) return c;
    }
    throw std::logic_error("insertion begins with a triangle: the points must not be in line");
  }

  void swap_points(Vertex a, Vertex b) {
    std::swap(order_.points[a], order_.points[b]);
    std::swap(order_.sweep_of[a], order_.sweep_of[b]);
  }

  template <typename KeepGoing>
  bool insert_all(KeepGoing&& keep_going) {
    constexpr std::int32_t kPointsPerQuestion = 4096;
    const Triangle unused = triangle_numbered(std::int64_t{2} * part_.begin + kStartTriangles);
    Cavity cavity(triangles_, unused, points_);
    std::int32_t until_question = kPointsPerQuestion;
    return InsertionRounds(part_.size()).for_each([&](std::uint32_t position) {
      if (position < kStartVertices) return true;
      if (--until_question == 0) {
        if (!keep_going(kPointsPerQuestion)) return false;
        until_question = kPointsPerQuestion;
      }
      const Vertex vertex{part_.begin + static_cast<std::int32_t>(position)};
      last_ = cavity.insert(vertex, find_conflict(point(vertex), last_));
      return true;
    });
  }

  // Walk towards p across edges that separate it, to a triangle whose circle holds it.
  Triangle find_conflict(Point p, Triangle triangle) {
    const GhostTriangle* const triangles = triangles_;
    const GhostTriangle& start = triangles[number(triangle)];
    // p is not right of the edge from `right` to `left`, seen from the triangle to search.
    Sight left = sight(start.corner[2], p), right = sight(start.corner[1], p);
    HalfEdge edge = half_edge(triangle, 0);
    if (is_right_of(right, left, p)) {
      edge = start.twin[0];
      std::swap(left, right);
    }
    int steps = 0;
    const HalfEdge end = walk_towards(edge, kMostSteps, [&](HalfEdge entry) {
      ++steps;
      const GhostTriangle& entered = triangles[number(triangle_of(entry))];
      const std::uint32_t corner = corner_of(entry);
      const Vertex vertex = entered.corner[corner];
      if (vertex == kGhost) return entry;
      const Sight apex = sight(vertex, p);
      if (is_right_of(left, apex, p)) {
        right = apex;
        return entered.twin[corner_after(corner)];
      }
      if (is_right_of(apex, right, p)) {
        left = apex;
        return entered.twin[corner_before(corner)];
      }
      return entry;
    });
    if (end == kNoHalfEdge) return find_straight(p, triangle);
    walk_steps_ += steps;
    return triangle_of(end);
  }

  TINSMITH_RARE Triangle find_straight(Point p, Triangle triangle) {
    const auto triangle_at = [this](Triangle t) -> const GhostTriangle& { return at(t); };
    const auto point_at = [this](Vertex v) { return point(v); };
    StraightWalk walk(triangle_at, point_at, 2 * static_cast<std::uint32_t>(part_.size()));
    const Triangle found = walk.find(p, triangle);
    walk_steps_ += walk.steps();
    return found;
  }

  struct Sight {  // a vertex as seen from p
    double x, y;
    Vertex vertex;
  };
  Sight sight(Vertex vertex, Point p) const {
    return {point(vertex).x - p.x, point(vertex).y - p.y, vertex};
  }

  // Is p right of the line from a to b? (As `orientation`, from differences at hand.)
  bool is_right_of(const Sight& a, const Sight& b, Point p) const {
    const double left = a.x * b.y, right = a.y * b.x;
    const double side = left - right;
    const double bound = detail::kOrientationBound * (std::fabs(left) + std::fabs(right));
    if (side > bound || -side > bound) return side < 0.0;
    return orientation(point(a.vertex), point(b.vertex), p) < 0;
  }

  // Most walks take three or four steps; one that takes so many has strayed among slivers.
  static constexpr int kMostSteps = 300;
  static constexpr std::uint32_t kStartVertices = 3;
  static constexpr std::uint32_t kStartTriangles = 4;

  CurveOrder& order_;
  const Point* points_;
  Range part_;
  GhostTriangle* triangles_;
  Triangle last_{0};
  std::int64_t walk_steps_ = 0;
};

}  // namespace tinsmith
