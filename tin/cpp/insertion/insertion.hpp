// Insertion: the same triangulation by local change, one point at a time, for points so uneven
// that a grid does not help the growth.
//
// A new point alters only its domain of influence: the triangles whose circle holds it. They are
// removed and the hole is filled with a fan about the point (cavity.hpp). Ties are decided by the
// point set alone (is_in_circle), so the result is the growth's. The order of insertion
// (insertion_rounds.hpp) only sets the speed.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <utility>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "../index/grid.hpp"
#include "../index/hilbert_order.hpp"
#include "../location/visibility_walk.hpp"
#include "../predicates/predicates.hpp"
#include "cavity.hpp"
#include "ghost_mesh.hpp"
#include "insertion_rounds.hpp"
#include "straight_walk.hpp"

namespace tinsmith {

class Insertion {
 public:
  // The points must not all be collinear.
  explicit Insertion(const PointGrid& grid)
      : grid_(grid),
        count_(grid.count()),
        sweep_of_(count_ + std::size_t{1}),
        points_(count_ + std::size_t{1}) {}

  // Returns false if `keep_going` did.
  template <typename KeepGoing>
  bool run(KeepGoing&& keep_going) {
    if (!keep_going()) return false;
    put_in_order();
    if (!keep_going()) return false;
    start();
    const bool is_complete = insert_all(keep_going);
    if (is_complete) number_by_sweep();
    return is_complete;
  }

  GhostMesh& mesh() { return mesh_; }

  // Triangles that were walked through to find where points go.
  std::int64_t walk_steps() const { return walk_steps_; }

 private:
  // By vertex, with a place for the ghost in front.
  template <typename T>
  class WithGhost {
   public:
    explicit WithGhost(std::size_t count) : values_(scratch_array<T>(count)) {}
    T& operator[](Vertex v) { return begin()[number(v)]; }
    const T& operator[](Vertex v) const { return begin()[number(v)]; }
    T* begin() const { return values_.get() + 1; }
    void release() { values_.reset(); }

   private:
    ScratchArray<T> values_;
  };

  void put_in_order() {
    const auto point = [this](std::int32_t i) { return grid_.point(Vertex{i}); };
    const HilbertOrder order(count_, point);
    for (const Vertex v : Ids<Vertex>(count_)) {
      sweep_of_[v] = Vertex{order[number(v)]};
      points_[v] = point(order[number(v)]);
    }
    constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
    points_[kGhost] = {kNotANumber, kNotANumber};
    sweep_of_[kGhost] = kGhost;
  }

  // The first triangle, of points that are not in line, and a ghost on each of its edges.
  void start() {
    constexpr Vertex first{0}, second{1}, third{2};
    swap_points(second, Vertex{count_ / 2});
    swap_points(third, not_in_line(first, second));
    const bool is_left = orientation(points_[first], points_[second], points_[third]) > 0;
    const Vertex a = first, b = is_left ? second : third, c = is_left ? third : second;
    mesh_.triangles = scratch_array<GhostTriangle>(2 * static_cast<std::size_t>(count_) - 2);
    constexpr Triangle t{0}, u{1}, v{2}, w{3};
    mesh_[t] = {{a, b, c}, {half_edge(u, 0), half_edge(v, 0), half_edge(w, 0)}};
    mesh_[u] = {{kGhost, c, b}, {half_edge(t, 0), half_edge(w, 2), half_edge(v, 1)}};
    mesh_[v] = {{kGhost, a, c}, {half_edge(t, 1), half_edge(u, 2), half_edge(w, 1)}};
    mesh_[w] = {{kGhost, b, a}, {half_edge(t, 2), half_edge(v, 2), half_edge(u, 1)}};
    mesh_.count = kStartTriangles;
  }

  Vertex not_in_line(Vertex a, Vertex b) const {
    for (const Vertex c : Ids<Vertex>(count_)) {
      if (orientation(points_[a], points_[b], points_[c]) != 0) return c;
    }
    throw std::logic_error("insertion begins with a triangle: the points must not be in line");
  }

  void swap_points(Vertex a, Vertex b) {
    std::swap(points_[a], points_[b]);
    std::swap(sweep_of_[a], sweep_of_[b]);
  }

  template <typename KeepGoing>
  bool insert_all(KeepGoing&& keep_going) {
    constexpr std::uint32_t kPointsPerQuestion = 4096;
    Cavity cavity(mesh_, points_.begin());
    Triangle last{0};
    std::uint32_t until_question = kPointsPerQuestion;
    return InsertionRounds(count_).for_each([&](std::uint32_t position) {
      const Vertex vertex{static_cast<std::int32_t>(position)};
      if (vertex < kFirstInserted) return true;
      if (--until_question == 0) {
        if (!keep_going()) return false;
        until_question = kPointsPerQuestion;
      }
      last = cavity.insert(vertex, find_conflict(points_[vertex], last));
      return true;
    });
  }

  // Walk towards p across edges that separate it, to a triangle whose circle holds it.
  Triangle find_conflict(Point p, Triangle triangle) {
    const GhostTriangle* const triangles = mesh_.triangles.get();
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
    const auto triangle_at = [this](Triangle t) -> const GhostTriangle& { return mesh_[t]; };
    const auto point_at = [this](Vertex v) { return points_[v]; };
    StraightWalk walk(triangle_at, point_at, mesh_.count);
    const Triangle found = walk.find(p, triangle);
    walk_steps_ += walk.steps();
    return found;
  }

  struct Sight {  // a vertex as seen from p
    double x, y;
    Vertex vertex;
  };
  Sight sight(Vertex vertex, Point p) const {
    return {points_[vertex].x - p.x, points_[vertex].y - p.y, vertex};
  }

  // Is p right of the line from a to b? (As `orientation`, from differences at hand.)
  bool is_right_of(const Sight& a, const Sight& b, Point p) const {
    const double left = a.x * b.y, right = a.y * b.x;
    const double side = left - right;
    const double bound = detail::kOrientationBound * (std::fabs(left) + std::fabs(right));
    if (side > bound || -side > bound) return side < 0.0;
    return orientation(points_[a.vertex], points_[b.vertex], p) < 0;
  }

  void number_by_sweep() {
    points_.release();
    for (std::uint32_t t = 0; t < mesh_.count; ++t) {
      for (Vertex& corner : mesh_.triangles[t].corner) corner = sweep_of_[corner];
    }
    sweep_of_.release();
  }

  // Most walks take three or four steps; one that takes so many has strayed among slivers.
  static constexpr int kMostSteps = 300;
  static constexpr Vertex kFirstInserted{3};
  static constexpr std::uint32_t kStartTriangles = 4;

  const PointGrid& grid_;
  std::int32_t count_;
  WithGhost<Vertex> sweep_of_;  // by position on the curve, which is the number of a vertex here
  WithGhost<Point> points_;     // likewise
  GhostMesh mesh_;
  std::int64_t walk_steps_ = 0;
};

}  // namespace tinsmith
