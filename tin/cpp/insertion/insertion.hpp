// Insertion: the same triangulation by local change, one point at a time, for points so uneven
// that a grid does not help the growth.
//
// A new point alters only its domain of influence: the triangles whose circle holds it. They are
// removed and the hole is filled with a fan about the point (cavity.hpp). Ties are decided by the
// point set alone (is_in_circle), so the result is the growth's. The order of insertion
// (insertion_order.hpp) only sets the speed.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "../base/ids.hpp"
#include "../base/arrays.hpp"
#include "../index/grid.hpp"
#include "../index/spatial_order.hpp"
#include "../predicates/predicates.hpp"
#include "cavity.hpp"
#include "ghost_mesh.hpp"
#include "insertion_order.hpp"
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
    T& operator[](std::int32_t vertex) { return begin()[vertex]; }
    const T& operator[](std::int32_t vertex) const { return begin()[vertex]; }
    T* begin() const { return values_.get() + 1; }
    void release() { values_.reset(); }

   private:
    ScratchArray<T> values_;
  };

  void put_in_order() {
    const auto place = [this](std::int32_t i) { return grid_.point(static_cast<Vertex>(i)); };
    const SpatialOrder order(count_, place);
    for (std::int32_t i = 0; i < count_; ++i) {
      sweep_of_[i] = order[i];
      points_[i] = place(order[i]);
    }
    constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
    points_[kGhost] = {kNotANumber, kNotANumber};
    sweep_of_[kGhost] = kGhost;
  }

  // The first triangle, of points that are not in line, and a ghost on each of its edges.
  void start() {
    swap_points(1, count_ / 2);
    std::int32_t third = 2;
    while (orientation(points_[0], points_[1], points_[third]) == 0) ++third;
    swap_points(2, third);
    const bool is_left = orientation(points_[0], points_[1], points_[2]) > 0;
    const std::int32_t a = 0, b = is_left ? 1 : 2, c = is_left ? 2 : 1;
    mesh_.triangles = scratch_array<GhostTriangle>(2 * static_cast<std::size_t>(count_) - 2);
    mesh_.triangles[0] = {{a, b, c}, {mesh_edge(1, 0), mesh_edge(2, 0), mesh_edge(3, 0)}};
    mesh_.triangles[1] = {{kGhost, c, b}, {mesh_edge(0, 0), mesh_edge(3, 2), mesh_edge(2, 1)}};
    mesh_.triangles[2] = {{kGhost, a, c}, {mesh_edge(0, 1), mesh_edge(1, 2), mesh_edge(3, 1)}};
    mesh_.triangles[3] = {{kGhost, b, a}, {mesh_edge(0, 2), mesh_edge(2, 2), mesh_edge(1, 1)}};
    mesh_.count = kStartTriangles;
  }

  void swap_points(std::int32_t a, std::int32_t b) {
    std::swap(points_[a], points_[b]);
    std::swap(sweep_of_[a], sweep_of_[b]);
  }

  template <typename KeepGoing>
  bool insert_all(KeepGoing&& keep_going) {
    constexpr std::uint32_t kPointsPerQuestion = 4096;
    Cavity cavity(mesh_, points_.begin());
    std::uint32_t last = 0;
    std::uint32_t until_question = kPointsPerQuestion;
    return InsertionRounds(count_).for_each([&](std::uint32_t place) {
      const auto vertex = static_cast<std::int32_t>(place);
      if (vertex < kStartVertices) return true;
      if (--until_question == 0) {
        if (!keep_going()) return false;
        until_question = kPointsPerQuestion;
      }
      last = cavity.insert(vertex, find_conflict(points_[vertex], last));
      return true;
    });
  }

  // Walk towards p across edges that separate it, to a triangle whose circle holds it.
  std::uint32_t find_conflict(Point p, std::uint32_t triangle) {
    const GhostTriangle* const triangles = mesh_.triangles.get();
    const GhostTriangle* here = &triangles[triangle];
    // p is not right of the edge from `right` to `left`, seen from the triangle to search.
    Sight left = sight(here->corner[2], p), right = sight(here->corner[1], p);
    std::uint32_t edge = mesh_edge(triangle, 0);
    if (is_right_of(right, left, p)) {
      edge = here->twin[0];
      std::swap(left, right);
    }
    for (int steps = 1; steps < kMostSteps; ++steps) {
      here = &triangles[triangle_of(edge)];
      const std::uint32_t place = place_of(edge);
      const std::int32_t vertex = here->corner[place];
      if (vertex == kGhost) return arrive(edge, steps);
      const Sight apex = sight(vertex, p);
      if (is_right_of(left, apex, p)) {
        edge = here->twin[place_after(place)];
        right = apex;
      } else if (is_right_of(apex, right, p)) {
        edge = here->twin[place_before(place)];
        left = apex;
      } else {
        return arrive(edge, steps);
      }
    }
    return find_straight(p, triangle);
  }

  std::uint32_t arrive(std::uint32_t edge, int steps) {
    walk_steps_ += steps;
    return triangle_of(edge);
  }

  TINSMITH_RARE std::uint32_t find_straight(Point p, std::uint32_t triangle) {
    const auto triangle_at = [this](std::uint32_t t) -> const GhostTriangle& {
      return mesh_.triangles[t];
    };
    const auto point_at = [this](std::int32_t vertex) { return points_[vertex]; };
    StraightWalk walk(triangle_at, point_at);
    const std::uint32_t found = walk.find(p, triangle);
    walk_steps_ += walk.steps();
    return found;
  }

  struct Sight {  // a vertex as seen from p
    double x, y;
    std::int32_t vertex;
  };
  Sight sight(std::int32_t vertex, Point p) const {
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
      for (std::int32_t& corner : mesh_.triangles[t].corner) corner = sweep_of_[corner];
    }
    sweep_of_.release();
  }

  // Most walks take three or four steps; one that takes so many has strayed among slivers.
  static constexpr int kMostSteps = 300;
  static constexpr std::int32_t kStartVertices = 3;
  static constexpr std::uint32_t kStartTriangles = 4;

  const PointGrid& grid_;
  std::int32_t count_;
  WithGhost<std::int32_t> sweep_of_;  // by place on the curve, which is the number of a vertex here
  WithGhost<Point> points_;           // likewise
  GhostMesh mesh_;
  std::int64_t walk_steps_ = 0;
};

}  // namespace tinsmith
